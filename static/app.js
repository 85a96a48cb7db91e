// Adds keys, a live try-out of words and local times to pages that work without it.

const store = {
  get off() { try { return localStorage.getItem("memrep-keys") === "off"; } catch { return false; } },
  set off(value) { try { localStorage.setItem("memrep-keys", value ? "off" : "on"); } catch { /* private window */ } },
};

// ---- keys -----------------------------------------------------------------

const dialog = document.getElementById("keys");
const keysButton = document.getElementById("keys-button");
const keysOff = document.getElementById("keys-off");

if (dialog && keysButton && keysOff) {
  keysButton.hidden = false;
  keysOff.checked = store.off;
  document.documentElement.classList.toggle("no-keys", store.off);
  keysOff.addEventListener("change", () => {
    store.off = keysOff.checked;
    document.documentElement.classList.toggle("no-keys", store.off);
  });
  keysButton.addEventListener("click", () => dialog.showModal());
}

const isTyping = (target) => target instanceof Element && target.closest("input, textarea, select, [contenteditable]") !== null;

let busy = false;

document.addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey || event.repeat || isTyping(event.target)) return;
  if (event.key === "?" && dialog) {
    event.preventDefault();
    if (dialog.open) dialog.close(); else dialog.showModal();
    return;
  }
  if (store.off || busy || dialog?.open) return;
  // Arrows scroll a wide drawing that has the focus.
  if (event.key.startsWith("Arrow") && event.target instanceof Element && event.target.closest(".scroll")) return;
  const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
  const button = [...document.querySelectorAll("button[data-key]")].find((b) => b.dataset.key === key);
  if (!button) return;
  event.preventDefault();
  button.classList.add("pressed");
  button.click();
});

// A form is sent once; going back makes it usable again.
document.addEventListener("submit", (event) => {
  if (event.target instanceof HTMLFormElement && event.target.method === "post") {
    if (busy) { event.preventDefault(); return; }
    busy = true;
    event.submitter?.classList.add("pressed");
  }
});
window.addEventListener("pageshow", () => {
  busy = false;
  document.querySelectorAll(".pressed").forEach((b) => b.classList.remove("pressed"));
});

// ---- the word that the rule treats wrongly ---------------------------------

const builder = document.getElementById("counterexample");

if (builder) {
  const rule = JSON.parse(builder.dataset.rule);
  const input = builder.querySelector("#word");
  const verdict = builder.querySelector("#verdict");
  const labels = [...builder.querySelectorAll('input[name="label"]')];
  const single = rule.symbols.every((name) => [...name].length === 1);
  const position = new Map(rule.symbols.map((name, i) => [name, i]));

  const tokens = () => input.value.split(/[\s,·]+/u).filter(Boolean)
    .flatMap((token) => position.has(token) || !single ? [token] : [...token]);

  const judge = () => {
    const word = tokens();
    const unknown = word.find((name) => !position.has(name));
    if (unknown !== undefined) {
      verdict.textContent = `“${unknown}” is not one of the names.`;
      return;
    }
    const end = word.reduce((state, name) => rule.delta[state][position.get(name)], rule.start);
    const accepted = rule.accepting[end];
    verdict.textContent = accepted ? "The rule above accepts this." : "The rule above does not accept this.";
    // What it should say can only be the opposite.
    for (const label of labels) label.checked = label.value === String(!accepted);
  };

  const set = (word) => {
    input.value = word.join(" ");
    judge();
  };

  const row = builder.querySelector("#chip-buttons");
  row.hidden = false;
  row.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const word = tokens();
    if (button.id === "chip-back") word.pop(); else word.push(button.dataset.append);
    set(word);
  });
  input.addEventListener("input", judge);
  if (input.value) judge();
}

// ---- times ------------------------------------------------------------------

for (const time of document.querySelectorAll("time[datetime]")) {
  const date = new Date(time.dateTime);
  if (!Number.isNaN(date.valueOf())) {
    time.textContent = date.toLocaleString(undefined, { dateStyle: "medium", timeStyle: "short" });
  }
}
