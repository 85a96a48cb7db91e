// Folds what stands beside the question on narrow pages, and keeps it as the person
// left it from card to card.

const NARROW = matchMedia("(max-width: 640px)");
const left = new Map();

export const enhance = (main, signal) => {
  for (const part of main.querySelectorAll("details[data-fold]")) {
    const name = part.dataset.fold;
    part.open = left.get(name) ?? !NARROW.matches;
    part.querySelector("summary").addEventListener("click", () => {
      // The click opens or closes it afterwards.
      left.set(name, !part.open);
    }, { signal });
  }
};
