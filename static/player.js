// Plays the behaviours of a card in step: one clock, one set of controls, and the
// tracks that follow the clock.

import { tracks } from "./tracks.js";

const SPEEDS = [0.5, 1, 2];
// The width of the scrubber's thumb, as the style sheet has it.
const THUMB = 20;
const still = matchMedia("(prefers-reduced-motion: reduce)");

const store = {
  get speed() {
    try {
      const kept = Number(localStorage.getItem("memrep-speed"));
      return SPEEDS.includes(kept) ? kept : 1;
    } catch { return 1; }
  },
  set speed(value) { try { localStorage.setItem("memrep-speed", String(value)); } catch { /* private window */ } },
};

const element = (tag, className, text) => {
  const made = document.createElement(tag);
  made.className = className;
  if (text !== undefined) made.textContent = text;
  return made;
};

const button = (text, key, shown) => {
  const made = element("button", "small");
  made.type = "button";
  const label = element("span", "", text);
  made.append(label);
  if (key) {
    made.dataset.key = key;
    made.dataset.plays = "";
    const kbd = element("kbd", "", shown);
    kbd.setAttribute("aria-hidden", "true");
    made.append(" ", kbd);
  }
  return [made, label];
};

/** The controls of a card, before anything moves. */
const build = (both, keyed) => {
  const controls = element("div", "controls");
  controls.setAttribute("role", "group");
  controls.setAttribute("aria-label", "Play the behaviour");
  const [play, playText] = button("Play", keyed && " ", "Space");
  play.classList.add("play-button");
  const [replay] = button("Replay", keyed && "r", "R");
  const speeds = element("span", "speeds");
  speeds.setAttribute("role", "group");
  speeds.setAttribute("aria-label", "Speed");
  const speedButtons = SPEEDS.map((speed) => {
    const [made] = button(`${speed}×`);
    made.dataset.speed = speed;
    speeds.append(made);
    return made;
  });
  const rail = element("span", "rail");
  const slider = element("input", "scrubber");
  slider.type = "range";
  slider.min = 0;
  slider.setAttribute("aria-label", both ? "Step of both" : "Step");
  rail.append(slider);
  const count = element("span", "count");
  controls.append(play, replay, speeds, rail, count);
  return { controls, play, playText, replay, speeds, speedButtons, rail, slider, count };
};

/** A card: what has `data-player`, or a figure by itself. */
const player = (card, signal) => {
  const found = tracks(card, signal);
  if (found.length === 0) return;
  const both = card.querySelectorAll(".card, .pair > div").length > 1;
  const own = card.dataset.player === "auto";
  const parts = build(both, own);
  const { controls, play, playText, replay, speeds, speedButtons, rail, slider, count } = parts;
  // In steps where all go by steps, and else in thirtieths of a second.
  const stepped = found.every((track) => track.steps > 0);
  const longest = () => Math.max(1, ...found.map((track) => track.steps || 0));
  const pace = () => stepped ? Math.min(600, Math.max(160, 7000 / longest())) : 1000 / 30;
  const end = () => Math.max(...found.map((track) => track.ends(pace())));
  const whole = () => Math.max(1, Math.round(end() / pace()));

  let at = 0;
  let last = 0;
  let frame = 0;
  let speed = store.speed;

  const draw = () => {
    const total = whole();
    const place = Math.min(total, Math.round(at / pace() * 1000) / 1000);
    slider.max = total;
    slider.value = stepped ? Math.floor(place + 0.001) : Math.round(place);
    const said = stepped
      ? `Step ${slider.value} of ${total}`
      : `${(at / 1000).toFixed(1)} of ${(end() / 1000).toFixed(1)} s`;
    slider.setAttribute("aria-valuetext", said);
    count.textContent = said;
    for (const track of found) track.show(at, pace(), { moving: frame !== 0, speed, still: still.matches });
  };
  const rest = () => {
    cancelAnimationFrame(frame);
    frame = 0;
    playText.textContent = both ? "Play both" : "Play";
    play.setAttribute("aria-pressed", "false");
  };
  const pause = () => { rest(); draw(); };
  const tick = (now) => {
    at = Math.min(end(), at + (now - last) * speed);
    last = now;
    if (at >= end()) { pause(); return; }
    frame = requestAnimationFrame(tick);
    draw();
  };
  const start = () => {
    if (at >= end() - 1) at = 0;
    cancelAnimationFrame(frame);
    last = performance.now();
    frame = requestAnimationFrame(tick);
    playText.textContent = "Pause";
    play.setAttribute("aria-pressed", "true");
    draw();
  };
  const choose = (value) => {
    speed = value;
    for (const made of speedButtons) made.setAttribute("aria-pressed", String(Number(made.dataset.speed) === value));
  };
  const marks = () => {
    const parting = Math.max(-1, ...found.map((track) => track.parting ?? -1));
    if (!stepped || parting < 0 || parting > whole()) return;
    const mark = element("span", "parts-mark");
    mark.title = "Here the two part";
    // The thumb's middle never reaches the ends of the rail.
    mark.style.insetInlineStart = `calc(${THUMB / 2}px + (100% - ${THUMB}px) * ${parting / whole()})`;
    rail.append(mark);
  };

  play.addEventListener("click", () => { if (frame) pause(); else start(); }, { signal });
  replay.addEventListener("click", () => { at = 0; start(); }, { signal });
  speeds.addEventListener("click", ({ target }) => {
    const chosen = Number(target.closest("button")?.dataset.speed);
    if (!chosen) return;
    store.speed = chosen;
    choose(chosen);
  }, { signal });
  slider.addEventListener("input", () => {
    rest();
    at = Math.min(end(), Number(slider.value) * pace());
    draw();
  }, { signal });
  // After a press with the mouse the keys belong to the card again.
  controls.addEventListener("click", (event) => {
    if (event.detail > 0 && event.target.closest("button")) card.closest("[data-keys]")?.focus({ preventScroll: true });
  }, { signal });
  signal.addEventListener("abort", () => cancelAnimationFrame(frame));
  for (const track of found) track.ready?.(() => { at = Math.min(at, end()); if (!frame) draw(); });

  choose(speed);
  const pad = card.querySelector(":scope > .pad");
  const mend = card.querySelector(":scope > .said");
  if (pad ?? mend) (pad ?? mend).before(controls); else card.append(controls);
  card.classList.add("player");
  // What stands still shows all of a way, and the first of pictures.
  at = found.every((track) => track.whole) ? end() : 0;
  rest();
  marks();
  draw();
  // Once by itself, where motion is welcome and this is a question.
  if (own && !still.matches) {
    at = 0;
    start();
  }
};

// A picture that moves by itself stands still, where motion is unwelcome.
const stills = (figure, signal) => {
  if (!still.matches) return;
  const moving = figure.querySelector("img");
  const stop = () => {
    const first = document.createElement("canvas");
    Object.assign(first, { width: moving.naturalWidth, height: moving.naturalHeight });
    first.getContext("2d").drawImage(moving, 0, 0);
    first.setAttribute("role", "img");
    first.setAttribute("aria-label", moving.alt);
    const [play, text] = button("Play");
    play.addEventListener("click", () => {
      const standing = first.isConnected;
      (standing ? first : moving).replaceWith(standing ? moving : first);
      text.textContent = standing ? "Stop" : "Play";
    }, { signal });
    moving.replaceWith(first);
    figure.append(play);
  };
  if (moving.complete && moving.naturalWidth > 0) stop();
  else moving.addEventListener("load", stop, { once: true, signal });
};

export const enhance = (main, signal) => {
  for (const card of main.querySelectorAll("[data-player]")) player(card, signal);
  for (const figure of main.querySelectorAll("figure[data-frames]")) {
    if (!figure.closest("[data-player]")) player(figure, signal);
  }
  for (const figure of main.querySelectorAll("figure[data-animation]")) stills(figure, signal);
};
