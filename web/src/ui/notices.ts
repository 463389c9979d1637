// Short notices over the picture: what was done, what was refused and why, and a lost connection.

import { byId, el } from "./dom.ts";

const SHOWN_FOR = 6000; // ms
const MAX_NOTICES = 4;

export class Notices {
  private readonly place = byId("notices");
  private readonly banner = byId("lost");
  private timer = 0;

  constructor(retry: () => void) {
    byId("retry").addEventListener("click", retry);
  }

  /** Shows a text for some seconds; returns its element. */
  show(text: string, kind: "done" | "refused" | "finding"): HTMLElement {
    const same = [...this.place.children].find((one) => one.textContent === text);
    same?.remove();
    const notice = el("p", { class: kind }, text);
    notice.addEventListener("click", () => notice.remove());
    this.place.append(notice);
    while (this.place.children.length > MAX_NOTICES) this.place.firstElementChild?.remove();
    window.setTimeout(() => notice.remove(), SHOWN_FOR);
    return notice;
  }

  /** Shows a sentence until it is pressed. */
  explain(sentence: string): void {
    const notice = el("p", { class: "refused" }, sentence);
    notice.addEventListener("click", () => notice.remove());
    this.place.append(notice);
  }

  disconnected(retryAt: number): void {
    this.banner.hidden = false;
    document.body.classList.add("lost");
    window.clearInterval(this.timer);
    const count = (): void => {
      const left = Math.ceil((retryAt - performance.now()) / 1000);
      byId("lost-wait").textContent = left > 0 ? `Trying again in ${left} s.` : "Trying again \u2026";
    };
    count();
    this.timer = window.setInterval(count, 250);
  }

  connected(): void {
    window.clearInterval(this.timer);
    this.banner.hidden = true;
    document.body.classList.remove("lost");
  }
}
