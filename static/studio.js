// Makes the studio immediate: rows come and go, parts show, the preview follows.

const PAUSE = 400;

export const enhance = (main, signal) => {
  const form = main.querySelector("form#studio");
  if (!form) return;
  main.classList.add("scripted");

  // ---- parts that belong to a choice ----
  const show = () => {
    for (const part of form.querySelectorAll("[data-field]")) {
      const value = form.elements[part.dataset.field].value || "none";
      part.hidden = !part.dataset.values.split(" ").includes(value);
    }
  };

  // ---- rows ----
  const list = (name) => form.querySelector(`ol[data-rows="${name}"]`);

  // The field names of a list are numbered as its rows stand.
  const number = (rows) => {
    [...rows.children].forEach((row, place) => {
      const old = row.dataset.row;
      const swap = (text, from, to) => text.replace(from, to);
      const prefix = rows.dataset.rows;
      const id = prefix.replaceAll(".", "-");
      for (const element of row.querySelectorAll("*")) {
        for (const name of ["name", "id", "for", "aria-describedby", "value"]) {
          const value = element.getAttribute(name);
          if (value === null || (name === "value" && element.localName !== "button")) continue;
          element.setAttribute(name, swap(swap(value, `${prefix}[${old}]`, `${prefix}[${place}]`), `${id}-${old}-`, `${id}-${place}-`));
        }
      }
      const count = row.querySelector("button .unseen");
      if (count) count.textContent = ` ${place + 1}`;
      row.dataset.row = place;
    });
  };

  const add = (name) => {
    const rows = list(name);
    const row = form.querySelector(`template[data-row-of="${name}"]`).content.firstElementChild.cloneNode(true);
    rows.append(row);
    number(rows);
    return row;
  };

  const compose = (name) => {
    const at = (key) => form.elements[`${name}.${key}`].value.trim();
    const [x, y] = [at("x"), at("y")];
    const rule = { before: `${x} before ${y}`, never: `never ${x} after ${y}` }[at("form")] ?? `${at("form")} ${x}`;
    add(name).querySelector("input").value = rule;
  };

  form.addEventListener("click", (event) => {
    const button = event.target.closest("button[name=do]");
    if (!button) return;
    const [verb, name] = button.value.split(" ");
    if (verb === "add") {
      add(name).querySelector("input")?.focus();
    } else if (verb === "remove") {
      const row = button.closest("li");
      const rows = row.parentElement;
      const next = row.nextElementSibling ?? row.previousElementSibling;
      row.remove();
      number(rows);
      (next?.querySelector("button[name=do]") ?? form.querySelector(`button[value="add ${rows.dataset.rows}"]`))?.focus();
    } else if (verb === "rule") {
      compose(name);
    } else {
      return;
    }
    event.preventDefault();
    form.dispatchEvent(new Event("input"));
  }, { signal });

  // A file that is saved leaves the page as it is, so it may be sent again.
  form.addEventListener("submit", (event) => {
    if (event.submitter?.value.startsWith("save")) event.stopPropagation();
  }, { signal });

  // ---- what follows from what is typed ----
  const names = () => {
    const fields = [...list("symbols").querySelectorAll("input[name$='.name']")];
    const options = fields.map((field) => field.value.trim()).filter(Boolean).map((name) => {
      const option = document.createElement("option");
      option.value = name;
      return option;
    });
    form.querySelector("#symbol-names").replaceChildren(...options);
  };

  let timer;
  let asked = 0;
  const preview = async () => {
    const data = new FormData(form);
    data.delete("file");
    data.set("do", "preview");
    const mine = ++asked;
    try {
      const reply = await fetch("/studio", { method: "POST", body: data, signal });
      if (!reply.ok || mine !== asked) return;
      const page = new DOMParser().parseFromString(await reply.text(), "text/html");
      main.querySelector("#preview").replaceChildren(...page.body.childNodes);
    } catch { /* The preview stays as it is; “Check” asks again. */ }
  };
  const follow = () => {
    show();
    names();
    clearTimeout(timer);
    timer = setTimeout(preview, PAUSE);
  };
  // What fills fields in a person's stead may tell of one of them alone.
  for (const name of ["input", "change"]) form.addEventListener(name, follow, { signal });
  signal.addEventListener("abort", () => clearTimeout(timer));

  show();
  main.querySelector("#said[tabindex]")?.focus();
};
