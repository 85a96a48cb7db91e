// Tries the word of a counterexample out on the rule, and says what becomes of it.

import { carried, follow } from "./trace.js";

export const enhance = (main, signal) => {
  const builder = main.querySelector("#counterexample[data-rule]");
  if (!builder) return;
  const { rule, tokens, unknown, states } = carried(builder);
  const input = builder.querySelector("#word");
  const verdict = builder.querySelector("#verdict");
  const labels = [...builder.querySelectorAll('input[name="label"]')];

  const judge = () => {
    const word = tokens(input.value);
    const stranger = unknown(word);
    if (stranger !== undefined) {
      verdict.textContent = `“${stranger}” is not one of the names.`;
      return;
    }
    const accepted = rule.accepting[states(word).at(-1)];
    verdict.textContent = accepted ? "The rule above accepts this." : "The rule above does not accept this.";
    // What it should say can only be the opposite.
    for (const label of labels) label.checked = label.value === String(!accepted);
    follow(main, word);
  };

  const row = builder.querySelector("#chip-buttons");
  row.hidden = false;
  row.addEventListener("click", (event) => {
    const button = event.target.closest("button");
    if (!button) return;
    const word = tokens(input.value);
    if (button.id === "chip-back") word.pop(); else word.push(button.dataset.append);
    input.value = word.join(" ");
    judge();
  }, { signal });
  input.addEventListener("input", judge, { signal });
  if (input.value) judge();
};
