// What a card shows of behaviours, each as a track that follows the player's clock:
// walks, rows of chips, pictures, films and drives.

const SVG = "http://www.w3.org/2000/svg";
// How long the longest drive of a card plays, and one picture, in milliseconds.
const DRIVE = 6000;

const clamp = (value, least, most) => Math.min(most, Math.max(least, value));

/** Lights up what has been reached: `reached` of these, the last one most. */
const light = (elements, reached, resting) => elements.forEach((element, i) => {
  element.classList.toggle("ahead", !resting && i >= reached);
  element.classList.toggle("now", !resting && i === reached - 1);
});

const chipsOf = (side) => [...side.querySelectorAll(":scope > .word .chip, :scope .word .chip")];

/** A walk: its token moves along the way, what it touches lights up. */
const walk = (scene, side) => {
  const points = scene.dataset.points.split(" ").map((point) => point.split(",").map(Number));
  const token = scene.querySelector(".token");
  const way = scene.querySelector(".way:not(.under)");
  const touches = [...scene.querySelectorAll(".touch")];
  const at = touches.map((touch) => Number(touch.dataset.step));
  const chips = touches.length > 0 ? chipsOf(side) : [];
  const gone = way.cloneNode();
  gone.setAttribute("class", "way gone");
  way.after(gone);
  const tile = document.createElementNS(SVG, "rect");
  for (const [name, value] of [["class", "lit"], ["width", 28], ["height", 28], ["rx", 3]]) tile.setAttribute(name, value);
  way.before(tile);
  const steps = points.length - 1;
  return {
    steps: Math.max(1, steps),
    whole: true,
    parting: scene.dataset.parting === undefined ? null : Number(scene.dataset.parting),
    ends: (pace) => steps * pace,
    show: (clock, pace, { still }) => {
      const exact = clamp(clock / pace, 0, steps);
      const step = Math.floor(exact + 0.001);
      const share = still ? 0 : exact - step;
      const [x, y, angle] = points[step];
      const [nextX, nextY, nextAngle] = points[Math.min(step + 1, steps)];
      const [nowX, nowY] = [x + share * (nextX - x), y + share * (nextY - y)];
      token.setAttribute("transform", `translate(${nowX} ${nowY}) rotate(${share > 0.001 ? nextAngle : angle})`);
      const resting = step >= steps;
      scene.classList.toggle("under-way", !resting);
      const line = points.slice(0, step + 1).map(([px, py]) => `${px} ${py}`);
      gone.setAttribute("d", `M${line.join("L")}L${nowX} ${nowY}`);
      const reached = at.filter((touched) => touched <= step).length;
      light(touches, reached, resting);
      light(chips, reached, resting);
      const lit = !resting && reached > 0 && at[reached - 1] === step ? points[step] : null;
      tile.classList.toggle("on", lit !== null);
      if (lit) {
        tile.setAttribute("x", Math.floor(lit[0] / 32) * 32 + 2);
        tile.setAttribute("y", Math.floor(lit[1] / 32) * 32 + 2);
      }
    },
  };
};

/** A word without a world: its chips light up in step. */
const word = (chips) => {
  const parting = chips.findIndex((chip) => chip.classList.contains("parts"));
  return {
    steps: chips.length,
    whole: true,
    parting: parting < 0 ? null : parting,
    ends: (pace) => chips.length * pace,
    show: (clock, pace) => {
      const reached = Math.floor(clock / pace + 0.001);
      light(chips, reached, reached >= chips.length);
    },
  };
};

/** Pictures, one after the other. */
const pictures = (figure) => {
  const strip = figure.querySelector(".strip");
  const all = [...strip.querySelectorAll("li")];
  strip.removeAttribute("tabindex");
  figure.classList.add("one-by-one");
  const steps = all.length - 1;
  return {
    steps,
    whole: false,
    ends: (pace) => steps * pace,
    show: (clock, pace) => {
      const place = clamp(Math.floor(clock / pace + 0.001), 0, steps);
      all.forEach((picture, i) => { picture.hidden = i !== place; });
      // The next is there when its turn comes.
      for (const picture of all.slice(place, place + 3)) picture.querySelector("img").loading = "eager";
    },
  };
};

/** A film: it plays at the clock's speed, and is put right where it strays. */
const film = (video, signal) => {
  const length = () => Number.isFinite(video.duration) ? video.duration * 1000 : 1000;
  return {
    steps: 0,
    whole: false,
    ends: length,
    ready: (then) => video.addEventListener("loadedmetadata", then, { signal }),
    show: (clock, _, { moving, speed }) => {
      const place = Math.min(clock, length()) / 1000;
      video.playbackRate = speed;
      const plays = moving && clock < length();
      if (plays && video.paused) video.play().catch(() => { /* the clock moves it */ });
      if (!plays && !video.paused) video.pause();
      if (video.readyState > 0 && Math.abs(video.currentTime - place) > (plays ? 0.25 : 0.02)) video.currentTime = place;
    },
  };
};

/** A drive: the car moves along its way, as long as it lasts beside the longest. */
const drive = (picture, longest) => {
  const way = picture.querySelector(".way");
  const car = picture.querySelector(".car");
  const rests = car.getAttribute("transform");
  const gap = picture.querySelectorAll(".gap, .gap-ends, .gap-text");
  const length = way.getTotalLength();
  const lasts = DRIVE * Number(picture.dataset.lasts) / longest;
  return {
    steps: 0,
    whole: true,
    ends: () => lasts,
    show: (clock) => {
      const share = clamp(clock / lasts, 0, 1);
      const resting = share >= 1;
      gap.forEach((part) => part.classList.toggle("ahead", !resting && share < 0.5));
      if (resting) { car.setAttribute("transform", rests); return; }
      const [here, next] = [0, 1].map((more) => way.getPointAtLength(share * length + more));
      const angle = Math.atan2(next.y - here.y, next.x - here.x) * 180 / Math.PI;
      car.setAttribute("transform", `translate(${here.x} ${here.y}) rotate(${share * length + 1 >= length ? 0 : angle})`);
    },
  };
};

/** All that moves on a card. */
export const tracks = (card, signal) => {
  if (card.matches("figure[data-frames]")) return card.querySelectorAll(".strip li").length > 1 ? [pictures(card)] : [];
  const sides = [...card.querySelectorAll(".card, .pair > div")];
  if (sides.length === 0) sides.push(card);
  const drives = [...card.querySelectorAll("svg.drive[data-lasts]")];
  const longest = Math.max(...drives.map((picture) => Number(picture.dataset.lasts)));
  const asks = card.dataset.player === "auto";
  return sides.flatMap((side) => {
    const found = [];
    const scene = side.querySelector("svg.scene[data-points]");
    const frames = side.querySelector("figure[data-frames]");
    const video = side.querySelector("figure video");
    const picture = side.querySelector("svg.drive[data-lasts]");
    const chips = chipsOf(side);
    if (scene && scene.dataset.points.includes(" ")) found.push(walk(scene, side));
    if (frames && frames.querySelectorAll(".strip li").length > 1) found.push(pictures(frames));
    if (video) found.push(film(video, signal));
    if (picture && longest > 0) found.push(drive(picture, longest));
    // Rows of chips move only where there is nothing else to see, and on a question.
    const seen = scene || side.querySelector(".recording");
    if (asks && !seen && chips.length > 1) found.push(word(chips));
    return found;
  });
};
