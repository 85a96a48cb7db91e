// Tries a typed word out on the rule that is on show, and says what becomes of it.

export const enhance = (main, signal) => {
  const builder = main.querySelector("#counterexample[data-rule]");
  if (!builder) return;
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
  }, { signal });
  input.addEventListener("input", judge, { signal });
  if (input.value) judge();
};
