// Says how far an upload is, and keeps the chosen files where something is wrong.

import { show } from "./swap.js";

const FILES = "input[type=file]";

export const enhance = (main, signal) => {
  const form = main.querySelector("#own-task");
  form?.addEventListener("submit", (event) => {
    const chosen = [...form.querySelectorAll(FILES)].some((input) => input.files.length > 0);
    if (!chosen) return;
    event.preventDefault();
    // It is sent here, and can be sent again.
    event.stopPropagation();
    send(form);
  }, { signal });
};

const send = (form) => {
  const line = form.querySelector("#progress");
  const [bar, text] = [line.querySelector("progress"), line.querySelector("span")];
  const submit = form.querySelector("button.primary");
  const say = (sentence) => { text.textContent = sentence; line.hidden = false; };
  const free = () => { submit.disabled = false; };
  submit.disabled = true;
  bar.value = 0;
  say("Sending…");
  const request = new XMLHttpRequest();
  request.open("POST", form.action);
  request.upload.addEventListener("progress", ({ lengthComputable, loaded, total }) => {
    if (!lengthComputable) return;
    bar.value = loaded / total;
    const size = (bytes) => (bytes / 1048576).toFixed(1);
    say(loaded < total ? `Sent ${size(loaded)} of ${size(total)} MiB` : "Sent. The recordings are being read…");
  });
  request.addEventListener("error", () => {
    say("The connection broke off, and nothing was kept: try again.");
    free();
  });
  request.addEventListener("load", () => {
    const page = new DOMParser().parseFromString(request.responseText, "text/html");
    let main = page.querySelector("main");
    if (request.status < 400 && request.responseURL) {
      location.assign(request.responseURL);
    } else if (main?.querySelector("#own-task")) {
      const kept = [...form.querySelectorAll(FILES)];
      main = show(page);
      for (const input of main.querySelectorAll(FILES)) {
        const before = kept.find((old) => old.id === input.id);
        if (!before) continue;
        // Of two files of one name the browser has the one that was chosen.
        for (const name of ["aria-invalid", "aria-describedby"]) {
          if (input.hasAttribute(name)) before.setAttribute(name, input.getAttribute(name));
          else before.removeAttribute(name);
        }
        input.replaceWith(before);
      }
      main.querySelector("#again")?.remove();
      main.querySelector("[aria-invalid]")?.focus();
    } else {
      say(main?.querySelector(".lead")?.textContent ?? "That did not work: try again.");
      free();
    }
  });
  const data = new FormData(form);
  const media = data.getAll("media");
  data.delete("media");
  // What systems leave in folders is no part of a recording.
  for (const file of media.filter((file) => !file.name.startsWith("."))) {
    data.append("media", file, file.webkitRelativePath || file.name);
  }
  request.send(data);
};
