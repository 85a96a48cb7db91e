// Lets a person draw a way on the grid, and types the behaviour that it gives.

const SIDE = 32;
const MOVES = { ArrowUp: [-1, 0], ArrowRight: [0, 1], ArrowDown: [1, 0], ArrowLeft: [0, -1] };
const ANGLES = { "-1,0": 270, "0,1": 0, "1,0": 90, "0,-1": 180 };

const element = (name, attributes) => {
  const made = document.createElementNS("http://www.w3.org/2000/svg", name);
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, value);
  return made;
};

export const enhance = (main, signal) => {
  const walk = main.querySelector("#walk[data-grid]");
  const input = main.querySelector("#counterexample #word");
  const scene = walk?.querySelector("svg.scene");
  if (!walk || !input || !scene) return;
  const grid = JSON.parse(walk.dataset.grid);
  const field = walk.querySelector("#walk-field");
  const now = walk.querySelector("#walk-now");
  const everyStep = grid.labelling === "every-step";
  const same = (a, b) => a[0] === b[0] && a[1] === b[1];
  const tile = ([row, column]) => grid.tiles[row]?.[column];
  const free = (cell) => tile(cell) !== undefined && tile(cell) !== "wall";
  const isStart = (cell) => grid.starts.some((start) => same(start, cell));
  let cells = [grid.starts[0]];
  walk.hidden = false;

  // The way is drawn on the scene by elements of its own.
  scene.querySelector(".token")?.remove();
  scene.querySelector(".start")?.remove();
  const under = element("path", { class: "way under" });
  const line = element("path", { class: "way" });
  const start = element("circle", { class: "start", r: 5 });
  const token = element("path", { class: "token", d: "M-7 -4A3 3 0 0 1 -4 -7H4L10 0L4 7H-4A3 3 0 0 1 -7 4Z" });
  scene.append(under, line, start, token);

  // A cell that is passed again is passed beside its middle.
  const points = () => {
    const passes = new Map();
    return cells.map((cell) => {
      const pass = passes.get(`${cell}`) ?? 0;
      passes.set(`${cell}`, pass + 1);
      const aside = [0, 5, -5, 8, -8][pass % 5];
      return [cell[1] * SIDE + SIDE / 2 + aside, cell[0] * SIDE + SIDE / 2 + aside];
    });
  };

  const given = () => cells.slice(1).map(tile).filter((symbol) => typeof symbol === "number");

  const place = (cell) => {
    const symbol = tile(cell);
    const what = typeof symbol === "number" ? `, ${grid.texts[symbol]}` : "";
    return `row ${cell[0] + 1}, column ${cell[1] + 1}${what}`;
  };

  const show = (said = "") => {
    const way = points();
    const path = way.map(([x, y], i) => `${i === 0 ? "M" : "L"}${x} ${y}`).join(" ");
    under.setAttribute("d", path);
    line.setAttribute("d", path);
    start.setAttribute("cx", way[0][0]);
    start.setAttribute("cy", way[0][1]);
    const [before, last] = [cells.at(-2), cells.at(-1)];
    const angle = before && !same(before, last) ? ANGLES[`${[last[0] - before[0], last[1] - before[1]]}`] : 0;
    token.setAttribute("transform", `translate(${way.at(-1).join(" ")}) rotate(${angle ?? 0})`);
    const moves = cells.length - 1;
    now.textContent = `${said}${moves} of ${grid.steps} moves; at ${place(last)}.`;
  };

  const tell = () => {
    show();
    input.value = given().map((symbol) => grid.names[symbol]).join(" ");
    input.dispatchEvent(new Event("input", { bubbles: true }));
  };

  const go = (cell) => {
    const from = cells.at(-1);
    const stays = same(cell, from);
    if (stays && !(everyStep && typeof tile(cell) === "number")) {
      show(cells.length === 1 ? "Go to a neighbouring cell. " : "To stay gives nothing here. ");
    } else if (Math.abs(cell[0] - from[0]) + Math.abs(cell[1] - from[1]) > 1) {
      if (cells.length === 1 && isStart(cell)) {
        cells = [cell];
        tell();
      } else {
        show("Only a neighbouring cell can be next. ");
      }
    } else if (!free(cell)) {
      show("There is a wall, or the edge. ");
    } else if (cells.length > grid.steps) {
      show("No more moves: take some back. ");
    } else {
      cells.push(cell);
      tell();
    }
  };

  const back = () => {
    if (cells.length > 1) cells.pop();
    tell();
  };

  const on = (target, type, what) => target.addEventListener(type, what, { signal });
  on(scene, "click", (event) => {
    const at = new DOMPoint(event.clientX, event.clientY).matrixTransform(scene.getScreenCTM().inverse());
    const cell = [Math.floor(at.y / SIDE), Math.floor(at.x / SIDE)];
    if (tile(cell) !== undefined) go(cell);
  });
  on(field, "keydown", (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const move = MOVES[event.key];
    const [row, column] = cells.at(-1);
    if (move) go([row + move[0], column + move[1]]);
    else if (event.key === " ") go([row, column]);
    else return;
    event.preventDefault();
    event.stopPropagation();
  });
  on(walk.querySelector("#walk-back"), "click", back);
  on(walk.querySelector("#walk-clear"), "click", () => {
    cells = [cells[0]];
    tell();
  });
  show();
};
