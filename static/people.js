// Tells how long an answer took, and makes the link of an invitation whole.

export const enhance = (main, signal) => {
  const took = main.querySelector("input[data-took]");
  if (took) {
    const since = performance.now();
    // Before the form is read, whoever sends it.
    document.addEventListener("submit", () => {
      took.value = String(Math.round(performance.now() - since));
    }, { signal, capture: true });
  }
  for (const link of main.querySelectorAll("input[data-link]")) {
    link.value = new URL(link.value, location.href).href;
    link.addEventListener("focus", () => link.select(), { signal });
  }
};
