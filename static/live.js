// Shows what became of a session elsewhere: in another tab, or by another person.

import { refresh } from "./swap.js";

let source = null;
let followed = "";

const bar = () => document.querySelector("header.bar[data-live]");

const close = () => {
  source?.close();
  source = null;
  followed = "";
};

// One connection for all pages of a session that this tab shows one after another;
// none while nobody looks at the tab: a browser has few for a site.
const follow = () => {
  const address = document.hidden ? "" : bar()?.dataset.live ?? "";
  if (address === followed) return;
  close();
  if (!address) return;
  followed = address;
  source = new EventSource(address);
  source.addEventListener("entries", (event) => {
    if (Number(event.data) > Number(bar()?.dataset.entries)) refresh();
  });
};

document.addEventListener("visibilitychange", follow);
window.addEventListener("pagehide", close);
window.addEventListener("pageshow", (event) => { if (event.persisted) follow(); });

export const enhance = follow;
