// Follows a behaviour through the rule that is drawn: its states and arrows light up.

/** The rule that an element carries, and how words are read and run. */
export const carried = (element) => {
  const rule = JSON.parse(element.dataset.rule);
  const single = rule.symbols.every((name) => [...name].length === 1);
  const position = new Map(rule.symbols.map((name, i) => [name, i]));
  const tokens = (text) => text.split(/[\s,·]+/u).filter(Boolean)
    .flatMap((token) => position.has(token) || !single ? [token] : [...token]);
  return {
    rule,
    tokens,
    /** The first name that is none; undefined where all are. */
    unknown: (word) => word.find((name) => !position.has(name)),
    /** The states on the way, the start first. */
    states: (word) => word.reduce(
      (way, name) => [...way, rule.delta[way.at(-1)][position.get(name)]],
      [rule.start],
    ),
    text: (name) => rule.texts[position.get(name)],
  };
};

/** Asks the drawing of this page to follow a word. */
export const follow = (main, word) => main.dispatchEvent(new CustomEvent("follow", { detail: word }));

export const enhance = (main, signal) => {
  const tracer = main.querySelector("#tracer[data-rule]");
  if (!tracer) return;
  const { rule, tokens, unknown, states, text } = carried(tracer);
  const drawing = main.querySelector("svg.automaton");
  const input = tracer.querySelector("#trace");
  const way = tracer.querySelector("#trace-way");
  const verdict = tracer.querySelector("#trace-verdict");
  const on = (target, type, what) => target.addEventListener(type, what, { signal });
  let at = 0;

  const light = (seen, place) => {
    if (!drawing) return;
    for (const part of drawing.querySelectorAll(".lit, .been")) part.classList.remove("lit", "been");
    const mark = (selector, name) => drawing.querySelector(selector)?.classList.add(name);
    for (const state of seen.slice(0, place)) mark(`[data-state="${state}"]`, "been");
    mark(`[data-state="${seen[place]}"]`, "lit");
    if (place > 0) mark(`[data-from="${seen[place - 1]}"][data-to="${seen[place]}"]`, "lit");
    // What is left out of the drawing is told below it.
    if (!drawing.querySelector(`[data-state="${seen[place]}"]`)) mark(".note", "lit");
  };

  const told = (state) => {
    const phrase = rule.phrases[state];
    return phrase.startsWith("state ") ? `${state}` : `${state}: ${phrase}`;
  };

  // Shows the word in the field up to the step `to`, or to its end.
  const show = (to) => {
    const word = tokens(input.value);
    const stranger = unknown(word);
    way.replaceChildren();
    if (stranger !== undefined) {
      verdict.textContent = `“${stranger}” is not one of the names: use ${rule.symbols.join(", ")}.`;
      light([rule.start], 0);
      return;
    }
    const seen = states(word);
    at = Math.max(0, Math.min(to ?? word.length, word.length));
    seen.forEach((state, place) => {
      const item = document.createElement("li");
      if (place > 0) {
        const by = document.createElement("strong");
        by.textContent = text(word[place - 1]);
        item.append(by, " → ");
      }
      item.append(told(state));
      if (place === at) item.setAttribute("aria-current", "step");
      way.append(item);
    });
    light(seen, at);
    const here = at < word.length ? `After ${at} of ${word.length} steps: ${told(seen[at])}. ` : "";
    verdict.textContent = here + (rule.accepting[seen.at(-1)] ? "The rule accepts this." : "The rule does not accept this.");
  };

  const set = (word) => {
    input.value = word.join(" ");
    show();
  };

  for (const row of tracer.querySelectorAll("#trace-chips, #trace-steps")) row.hidden = false;
  tracer.querySelector("#trace-run").hidden = true;
  on(tracer, "submit", (event) => {
    event.preventDefault();
    show();
  });
  on(input, "input", () => show());
  on(tracer, "click", (event) => {
    const button = event.target.closest("button[data-append], button[data-step]");
    if (!button) return;
    const { append, step } = button.dataset;
    if (append !== undefined) set([...tokens(input.value), append]);
    else if (step === "clear") set([]);
    else if (step === "drop") set(tokens(input.value).slice(0, -1));
    else show(at + Number(step));
  });
  on(main, "follow", (event) => set(event.detail));
  if (input.value) show();
};
