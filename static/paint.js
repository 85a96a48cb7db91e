// Paints the map of a grid by mouse, finger or keyboard; the map's text follows.

const MOST = 50;
const FIXED = [
  { mark: ".", text: "empty" },
  { mark: "#", text: "wall" },
  { mark: "S", text: "start" },
];
const STEPS = { ArrowUp: [-1, 0], ArrowDown: [1, 0], ArrowLeft: [0, -1], ArrowRight: [0, 1] };

const make = (name, attributes = {}, ...children) => {
  const element = document.createElement(name);
  for (const [key, value] of Object.entries(attributes)) element.setAttribute(key, value);
  element.append(...children);
  return element;
};

export const enhance = (main, signal) => {
  const place = main.querySelector("#painter");
  const form = main.querySelector("form#studio");
  if (!place || !form) return;
  const text = form.elements["world.map"];
  const [rowsField, columnsField] = [form.elements["map-rows"], form.elements["map-columns"]];
  const palette = make("div", { class: "palette", role: "radiogroup", "aria-label": "What is painted" });
  const board = make("div", { class: "board", role: "grid", "aria-label": "The map: arrow keys move, Space paints, and so does a letter" });
  const said = make("p", { class: "hint", role: "status" });
  place.replaceChildren(palette, board, said);
  place.hidden = false;

  let map = [];
  let cells = [];
  let brush = "#";
  let at = [0, 0];

  // What can be painted: what always can, and every symbol that has a mark.
  const brushes = () => {
    const rows = [...form.querySelectorAll('ol[data-rows="symbols"] > li')];
    const symbols = rows.flatMap((row, index) => {
      const field = (key) => row.querySelector(`input[name$=".${key}"]`).value.trim();
      const name = field("name");
      const mark = field("letter") || ([...name].length === 1 ? name : "");
      if ([...mark].length !== 1 || FIXED.some((fixed) => fixed.mark === mark)) return [];
      return [{ mark, text: field("word") || name, colour: field("colour"), tone: index % 8 }];
    });
    return [...FIXED, ...symbols];
  };
  let known = brushes();

  const dress = (element, mark) => {
    const look = known.find((one) => one.mark === mark);
    element.className = "cell";
    element.style.removeProperty("background");
    if (mark === "#") element.classList.add("wall");
    else if (mark === "S") element.classList.add("start");
    else if (look?.colour) {
      element.classList.add("tile", "own-colour");
      element.style.setProperty("background", look.colour);
    } else if (look?.tone !== undefined) element.classList.add("tile", `tone-${look.tone}`);
    else if (!look && mark !== " ") element.classList.add("unknown");
    element.textContent = mark === "." || mark === " " ? "" : mark;
  };

  const describe = ([row, column]) => {
    const mark = map[row][column];
    const look = known.find((one) => one.mark === (mark === " " ? "." : mark));
    return `Row ${row + 1}, column ${column + 1}: ${look?.text ?? mark}`;
  };

  const focus = (to) => {
    cells[at[0]]?.[at[1]]?.setAttribute("tabindex", "-1");
    at = to;
    const cell = cells[at[0]][at[1]];
    cell.setAttribute("tabindex", "0");
    cell.focus();
  };

  const write = () => {
    text.value = map.map((row) => row.join("")).join("\n");
    text.dispatchEvent(new Event("input", { bubbles: true }));
  };

  const paint = ([row, column], mark) => {
    if (map[row][column] === mark) return;
    map[row][column] = mark;
    dress(cells[row][column], mark);
    cells[row][column].setAttribute("aria-label", describe([row, column]));
    said.textContent = describe([row, column]);
    write();
  };

  const draw = () => {
    board.style.setProperty("--columns", map[0].length);
    at = [Math.min(at[0], map.length - 1), Math.min(at[1], map[0].length - 1)];
    cells = map.map((row, i) => row.map((mark, j) => {
      const cell = make("div", { role: "gridcell", tabindex: i === at[0] && j === at[1] ? "0" : "-1", "data-at": `${i} ${j}`, "aria-label": describe([i, j]) });
      dress(cell, mark);
      return cell;
    }));
    board.replaceChildren(...cells.map((row) => make("div", { role: "row" }, ...row)));
  };

  const offer = () => {
    known = brushes();
    if (!known.some((one) => one.mark === brush)) brush = "#";
    palette.replaceChildren(...known.map((one) => {
      const input = make("input", { type: "radio", name: "brush", value: one.mark });
      input.checked = one.mark === brush;
      const swatch = make("span", { "aria-hidden": "true" });
      dress(swatch, one.mark);
      return make("label", { class: "brush" }, input, swatch, one.text);
    }));
    for (const [i, row] of cells.entries()) row.forEach((cell, j) => dress(cell, map[i][j]));
  };

  // A map of this size, with what there is.
  const resize = (rows, columns) => {
    const side = (number) => Math.min(MOST, Math.max(1, number || 1));
    const line = (row) => Array.from({ length: side(columns) }, (_, column) => map[row]?.[column] ?? ".");
    map = Array.from({ length: side(rows) }, (_, row) => line(row));
    [rowsField.value, columnsField.value] = [map.length, map[0].length];
    draw();
  };

  const read = () => {
    const lines = text.value.replace(/^\n+|\n+$/gu, "").split("\n").map((line) => [...line]);
    const isBlank = lines.length === 1 && lines[0].length === 0;
    map = isBlank ? [] : lines.slice(0, MOST);
    const columns = Math.max(...lines.map((line) => line.length));
    resize(isBlank ? Number(rowsField.value) : map.length, isBlank ? Number(columnsField.value) : columns);
  };

  // ---- by mouse and finger ----
  let painting = false;
  const under = (event) => {
    const cell = document.elementFromPoint(event.clientX, event.clientY)?.closest("[data-at]");
    return cell && board.contains(cell) ? cell.dataset.at.split(" ").map(Number) : null;
  };
  board.addEventListener("pointerdown", (event) => {
    const to = event.button === 0 ? under(event) : null;
    if (!to) return;
    event.preventDefault();
    painting = true;
    focus(to);
    paint(to, brush);
  }, { signal });
  board.addEventListener("pointermove", (event) => {
    const to = painting ? under(event) : null;
    if (to) paint(to, brush);
  }, { signal });
  for (const name of ["pointerup", "pointercancel"]) {
    window.addEventListener(name, () => { painting = false; }, { signal });
  }

  // ---- by keyboard ----
  board.addEventListener("keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const step = STEPS[event.key];
    if (step) {
      const to = [at[0] + step[0], at[1] + step[1]];
      if (map[to[0]]?.[to[1]] !== undefined) focus(to);
    } else if (event.key === " " || event.key === "Enter") {
      paint(at, brush);
    } else {
      const same = (one) => one.mark === event.key || one.mark === event.key.toUpperCase();
      const one = known.find((each) => each.mark === event.key) ?? known.find(same);
      if (!one) return;
      paint(at, one.mark);
    }
    event.preventDefault();
    event.stopPropagation();
  }, { signal });

  palette.addEventListener("change", (event) => { brush = event.target.value; event.stopPropagation(); }, { signal });
  palette.addEventListener("input", (event) => event.stopPropagation(), { signal });
  form.querySelector('button[value="resize"]').addEventListener("click", (event) => {
    event.preventDefault();
    resize(Number(rowsField.value), Number(columnsField.value));
    write();
  }, { signal });
  text.addEventListener("input", (event) => { if (event.isTrusted) read(); }, { signal });
  form.addEventListener("input", (event) => {
    if (event.target === form || event.target.name?.startsWith("symbols[")) offer();
  }, { signal });

  read();
  offer();
};
