// Answers by key while the question's card has the focus, and the list of keys.

const store = {
  get off() { try { return localStorage.getItem("memrep-keys") === "off"; } catch { return false; } },
  set off(value) { try { localStorage.setItem("memrep-keys", value ? "off" : "on"); } catch { /* private window */ } },
};

const within = (target, selector) => target instanceof Element && target.closest(selector) !== null;
const TYPING = "input:not([type=range]), textarea, select, [contenteditable]";
// What has a use of its own for arrows and the space bar.
const ARROWS = "input[type=range], .scroll, video";
const PRESSED = "button, a[href], summary, video, input";

/** The card's button for this key. */
const button = (card, event) => {
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  if (key.startsWith("Arrow") && within(event.target, ARROWS)) return null;
  if (key === " " && within(event.target, PRESSED)) return null;
  return [...card.querySelectorAll("button[data-key]")].find((b) => b.dataset.key === key && !b.disabled);
};

const list = (signal) => {
  const dialog = document.getElementById("keys");
  const open = document.getElementById("keys-button");
  const off = document.getElementById("keys-off");
  if (!dialog || !open || !off) return null;
  open.hidden = false;
  off.checked = store.off;
  // The line at the top may be replaced by itself.
  document.addEventListener("click", ({ target }) => {
    if (within(target, "#keys-button")) dialog.showModal();
  }, { signal });
  return { dialog, off };
};

export const enhance = (main, signal) => {
  const { dialog, off } = list(signal) ?? {};
  const card = main.querySelector("[data-keys]");
  const state = card?.querySelector("[data-keys-state]");
  const root = document.documentElement;

  // The button that gives the keys to the card must not go before it is pressed.
  const listens = () => {
    const focus = document.activeElement;
    return !store.off && card.contains(focus) && !within(focus, `${TYPING}, [data-keys-state]`);
  };
  const tell = () => {
    root.classList.toggle("no-keys", store.off);
    if (!card) return;
    const on = listens();
    card.classList.toggle("keyed", on);
    if (!state) return;
    state.hidden = store.off;
    state.querySelector(".on").hidden = !on;
    state.querySelector(".off").hidden = on;
  };
  off?.addEventListener("change", () => { store.off = off.checked; tell(); }, { signal });
  document.addEventListener("focusin", tell, { signal });
  document.addEventListener("focusout", () => queueMicrotask(tell), { signal });
  state?.querySelector("button")?.addEventListener("click", () => card.focus({ preventScroll: true }), { signal });
  dialog?.addEventListener("close", tell, { signal });

  document.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || event.defaultPrevented) return;
    if (within(event.target, TYPING)) return;
    if (event.key === "?" && dialog) {
      event.preventDefault();
      if (dialog.open) dialog.close(); else dialog.showModal();
      return;
    }
    if (dialog?.open || !card || !listens()) return;
    const pressed = button(card, event);
    if (!pressed) return;
    event.preventDefault();
    if (!pressed.matches("[data-plays]")) pressed.classList.add("pressed");
    pressed.click();
  }, { signal });

  // The card has the focus when it comes, unless something else wants it.
  if (card && !main.querySelector("[autofocus], [aria-invalid=true]") && !location.hash
    && document.activeElement === document.body) {
    card.focus({ preventScroll: true });
  }
  tell();
};
