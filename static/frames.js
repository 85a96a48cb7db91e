// Turns a strip of pictures into one picture at a time, with buttons and a slider; and
// lets a picture that moves stand still, where motion is unwelcome.

const PERIOD = 500;
const still = matchMedia("(prefers-reduced-motion: reduce)");

const button = (text, label) => {
  const made = document.createElement("button");
  made.type = "button";
  made.className = "small";
  made.textContent = text;
  if (label) made.setAttribute("aria-label", label);
  return made;
};

const player = (figure, signal) => {
  const strip = figure.querySelector(".strip");
  const pictures = [...strip.querySelectorAll("li")];
  figure.removeAttribute("data-frames");
  if (pictures.length < 2) return;

  const slider = document.createElement("input");
  Object.assign(slider, { type: "range", min: 1, max: pictures.length, step: 1, value: 1 });
  slider.setAttribute("aria-label", "Picture");
  const count = document.createElement("span");
  count.className = "count";
  const play = button("Play");
  const controls = document.createElement("div");
  controls.className = "controls";
  controls.append(play, slider, count);

  const show = (place) => {
    pictures.forEach((picture, i) => { picture.hidden = i !== place; });
    // The next is there when its turn comes.
    for (const picture of pictures.slice(place, place + 3)) picture.querySelector("img").loading = "eager";
    slider.value = place + 1;
    slider.setAttribute("aria-valuetext", `${place + 1} of ${pictures.length}`);
    count.textContent = `${place + 1} / ${pictures.length}`;
  };

  let timer = 0;
  const pause = () => {
    clearInterval(timer);
    timer = 0;
    play.textContent = "Play";
  };
  const start = () => {
    if (Number(slider.value) >= pictures.length) show(0);
    play.textContent = "Pause";
    timer = setInterval(() => {
      const place = Number(slider.value);
      if (place >= pictures.length) pause(); else show(place);
    }, PERIOD);
  };
  play.addEventListener("click", () => { if (timer) pause(); else start(); }, { signal });
  signal.addEventListener("abort", pause);
  slider.addEventListener("input", () => { pause(); show(Number(slider.value) - 1); });

  figure.classList.add("player");
  strip.removeAttribute("tabindex");
  figure.append(controls);
  show(0);
  // Once by itself, where motion is welcome and this is a question.
  if (!still.matches && figure.closest(".answers")) start();
};

const stills = (figure) => {
  figure.removeAttribute("data-animation");
  if (!still.matches) return;
  const moving = figure.querySelector("img");
  const stop = () => {
    const first = document.createElement("canvas");
    Object.assign(first, { width: moving.naturalWidth, height: moving.naturalHeight });
    first.getContext("2d").drawImage(moving, 0, 0);
    first.setAttribute("role", "img");
    first.setAttribute("aria-label", moving.alt);
    const play = button("Play");
    play.addEventListener("click", () => {
      const standing = first.isConnected;
      (standing ? first : moving).replaceWith(standing ? moving : first);
      play.textContent = standing ? "Stop" : "Play";
    });
    moving.replaceWith(first);
    figure.append(play);
  };
  if (moving.complete && moving.naturalWidth > 0) stop();
  else moving.addEventListener("load", stop, { once: true });
};

export const enhance = (main, signal) => {
  main.querySelectorAll("figure[data-frames]").forEach((figure) => player(figure, signal));
  main.querySelectorAll("figure[data-animation]").forEach(stills);
};
