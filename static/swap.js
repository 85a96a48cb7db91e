// Sends forms marked `data-swap` and puts the page that comes in the place of this
// one, without a load; where that cannot be, the form goes as forms do.

// How long a send may take before the page says what it waits for.
const PATIENCE = 600;

const parser = new DOMParser();
let dress = () => {};
let current = new AbortController();
// The page as it was served, to know whether another differs.
let served = "";
// A form is on its way; what came of anything older is not shown.
let sending = false;
let turn = 0;
let again = 0;
// The page came as the answer to a form, and asking for it anew would lose it.
let told = false;
// What the address shows, without the place on the page.
let shown = "";

const here = () => location.pathname + location.search;
const main = () => document.querySelector("main");
const script = (page) => page.querySelector('script[src*="/static/"]')?.getAttribute("src");
const say = (text) => {
  const line = document.getElementById("came");
  if (line) line.textContent = text;
};

/** Lets `modules` add to the page, and to each that takes its place. */
export const begin = (modules) => {
  dress = modules;
  served = main()?.outerHTML ?? "";
  shown = here();
  if (main()) dress(main(), current.signal);
  document.addEventListener("submit", submitted);
  window.addEventListener("popstate", () => {
    if (here() !== shown) load(location.href);
  });
  window.addEventListener("pageshow", (event) => {
    free();
    if (event.persisted) refresh();
  });
};

/** Nothing on the page itself: forms are heard wherever they are. */
export const enhance = () => {};

const free = () => {
  sending = false;
  main()?.removeAttribute("aria-busy");
  for (const button of document.querySelectorAll(".pressed")) button.classList.remove("pressed");
};

// Where the focus goes: to what is wrong, to the card, or to the heading.
const focus = (place) => {
  const target = place.querySelector("[aria-invalid=true], [autofocus], [data-keys]") ?? place.querySelector("h1");
  if (!target) return;
  if (!target.matches("input, textarea, select, button, a[href], [tabindex]")) target.tabIndex = -1;
  target.focus({ preventScroll: true });
};

/** Puts the `<main>`, the header and the title of `page` in the place of these. */
export const show = (page) => {
  const next = document.adoptNode(page.querySelector("main"));
  const wait = page.querySelector('meta[http-equiv="refresh"]');
  current.abort();
  current = new AbortController();
  served = next.outerHTML;
  const bar = page.querySelector("header.bar");
  if (bar) document.querySelector("header.bar")?.replaceWith(document.adoptNode(bar));
  document.title = page.title;
  main().replaceWith(next);
  turn += 1;
  clearTimeout(again);
  // A page that waits for the learner looks again, as its own header says.
  if (wait) again = setTimeout(refresh, 1000 * (parseFloat(wait.content) || 3));
  dress(next, current.signal);
  return next;
};

const arrive = (page, address, direct = false) => {
  told = direct;
  if (address && address !== here()) history.pushState(null, "", address);
  shown = here();
  const next = show(page);
  scrollTo(0, 0);
  focus(next);
  const count = document.querySelector(".bar-count")?.textContent.trim();
  const asked = next.querySelector("h1")?.textContent.trim();
  say([asked, count && `${count}.`].filter(Boolean).join(" "));
};

// The page that came; none where it is no page of this build of the site, whose
// scripts would not fit.
const read = async (response) => {
  const type = response.headers.get("content-type") ?? "";
  if (!type.startsWith("text/html")) return null;
  const page = parser.parseFromString(await response.text(), "text/html");
  return page.querySelector("main") && script(page) === script(document) ? page : null;
};

const path = (address) => {
  const { pathname, search } = new URL(address, location.href);
  return pathname + search;
};

const load = async (address) => {
  const mine = ++turn;
  try {
    const response = await fetch(address, { cache: "no-store" });
    const page = await read(response);
    if (mine !== turn) return;
    if (page) arrive(page); else location.assign(address);
  } catch {
    if (mine === turn) location.assign(address);
  }
};

// Somebody is in the middle of a text.
const typing = () => {
  const field = document.activeElement;
  const isText = field?.matches("input:not([type=radio], [type=checkbox]), textarea");
  return isText && main().contains(field) && field.value !== field.defaultValue;
};

/** Fetches this page once more, and shows it where it is another than before. */
export const refresh = async () => {
  // A form that is being filled in is nobody's to replace.
  if (sending || !main() || main().matches("[data-typed]")) return;
  if (typing()) {
    clearTimeout(again);
    again = setTimeout(refresh, 3000);
    return;
  }
  const mine = ++turn;
  let page = null;
  try {
    page = await read(await fetch(location.href, { cache: "no-store" }));
  } catch {
    // No connection: what is shown stays, until there is one.
    if (mine !== turn) return;
    clearTimeout(again);
    again = setTimeout(refresh, 3000);
    return;
  }
  if (mine !== turn || sending) return;
  if (!page) { location.reload(); return; }
  const [before, after] = [main(), page.querySelector("main")];
  const asks = ({ dataset: { kind, question } }) => `${kind} ${question}`;
  const kept = before.querySelector("[data-keep]");
  if (after.outerHTML !== served && (kept || !(told && asks(before) === asks(after)))) {
    arrive(page);
    // What is told once stays until somebody goes elsewhere.
    if (kept) main().querySelector("[data-keep-before]")?.before(kept);
    return;
  }
  const [old, bar] = [document, page].map((place) => place.querySelector("header.bar"));
  if (bar && old && !old.contains(document.activeElement)) {
    old.replaceWith(document.adoptNode(bar));
    const keys = document.getElementById("keys-button");
    if (keys) keys.hidden = false;
  }
};

const submitted = (event) => {
  const form = event.target;
  if (!(form instanceof HTMLFormElement) || form.method !== "post" || event.defaultPrevented) return;
  if (sending) { event.preventDefault(); return; }
  sending = true;
  event.submitter?.classList.add("pressed");
  if (!form.matches("[data-swap]")) return;
  event.preventDefault();
  send(form, event.submitter);
};

const trouble = (form, submitter, text) => {
  free();
  document.getElementById("trouble")?.remove();
  const note = document.createElement("div");
  note.className = "notice";
  note.id = "trouble";
  note.setAttribute("role", "alert");
  const line = document.createElement("p");
  line.textContent = text;
  const button = document.createElement("button");
  button.type = "button";
  button.className = "small";
  button.textContent = "Send it again";
  button.addEventListener("click", () => {
    note.remove();
    if (submitter?.isConnected) form.requestSubmit(submitter); else form.requestSubmit();
  });
  note.append(line, button);
  main().prepend(note);
  note.scrollIntoView({ block: "nearest" });
  button.focus({ preventScroll: true });
};

const send = async (form, submitter) => {
  turn += 1;
  document.getElementById("trouble")?.remove();
  main().setAttribute("aria-busy", "true");
  const slow = setTimeout(() => say("Sent. The next page is being worked out."), PATIENCE);
  let response = null;
  let page = null;
  try {
    const body = new URLSearchParams(new FormData(form, submitter));
    response = await fetch(form.action, { method: "POST", body });
    page = await read(response);
  } catch {
    clearTimeout(slow);
    trouble(form, submitter, "This could not be sent: memrep does not answer. What you chose is kept here. Send it again once the connection is back; it counts once.");
    return;
  }
  clearTimeout(slow);
  if (page && response.status >= 500 && response.status !== 503) {
    trouble(form, submitter, page.querySelector(".lead")?.textContent ?? "That did not work.");
    return;
  }
  sending = false;
  if (page && response.redirected) arrive(page, path(response.url));
  else if (page) arrive(page, form.dataset.swap || here(), true);
  // It is done, or refused: a plain load shows which.
  else if (response.redirected) location.assign(response.url);
  else location.assign(form.dataset.swap || location.href);
};
