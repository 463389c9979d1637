// Which mission a server flies: the menu, and files that are dropped on the page or chosen.

import { type FlightScene, MAX_SIZE, type FlyMessage } from "../wire/messages.generated.ts";
import { el } from "./dom.ts";
import { isScript } from "./lecture_script.ts";
import { MissionMenu } from "./mission_menu.ts";
import type { Notices } from "./notices.ts";
import type { Question } from "./question.ts";

const MAX_NAME = 100; // characters
const NO_SERVER = "only a page of tandemlift live flies files";

export class MissionChoice {
  private menu: MissionMenu | null = null;
  private flown = "";
  private loading: HTMLElement | null = null;

  constructor(
    private readonly send: (message: FlyMessage) => void,
    private readonly notices: Notices,
    private readonly question: Question,
    private readonly script: (name: string, text: string) => void,
  ) {
    window.addEventListener("dragover", this.drag);
    window.addEventListener("dragleave", this.drag);
    window.addEventListener("drop", this.drop);
  }

  /** Whether another mission can be chosen. */
  get open(): boolean {
    return this.menu !== null;
  }

  scene({ missions, mission }: FlightScene): void {
    const fly = (name: string): void => this.fly({ type: "fly", mission: name });
    if (missions) this.menu ??= new MissionMenu(missions, fly);
    this.flown = mission;
    this.menu?.show(mission);
  }

  /** The person chooses a file. */
  choose(): void {
    const input = el("input", { type: "file" });
    input.addEventListener("change", () => void this.take(input.files));
    input.click();
  }

  /** A mission is flown, by its name or that of its file; the scene has the name of the mission itself. */
  done(name: string): void {
    this.loading?.remove();
    this.notices.show(`Flying ${name}`, "done");
  }

  refused(reason: string): void {
    this.menu?.show(this.flown);
    this.loading?.remove();
    this.question.tell("This mission is not flown", reason);
  }

  private fly(message: FlyMessage): void {
    if (new TextEncoder().encode(JSON.stringify(message)).length > MAX_SIZE - MAX_NAME) {
      this.refused(`${message.mission}: is longer than ${MAX_SIZE} bytes, the most that is flown here`);
      return;
    }
    this.loading?.remove();
    this.loading = this.notices.show(`Loading ${message.mission} \u2026`, "done");
    this.send(message);
  }

  private async take(files: FileList | null): Promise<void> {
    const file = files?.item(0);
    if (!file) return;
    if (files!.length > 1) {
      this.refused(`${file.name} and ${files!.length - 1} more: one file at a time`);
      return;
    }
    const mission = file.name.slice(-MAX_NAME);
    try {
      const toml = await file.slice(0, MAX_SIZE).text();
      if (isScript(toml)) this.script(mission, toml);
      else if (this.open) this.fly({ type: "fly", mission, toml });
      else this.refused(`${mission}: ${NO_SERVER}`);
    } catch {
      this.refused(`${mission}: cannot be read`);
    }
  }

  private readonly drag = (event: DragEvent): void => {
    if (!event.dataTransfer?.types.includes("Files")) return;
    event.preventDefault();
    document.body.classList.toggle("dropping", event.type === "dragover");
  };

  private readonly drop = (event: DragEvent): void => {
    document.body.classList.remove("dropping");
    const files = event.dataTransfer?.files;
    if (!files?.length) return;
    event.preventDefault();
    void this.take(files);
  };
}
