// Where a part of the vehicle touches a wall: a mark at the place, and an arrow out of the wall.

import { Group, Vector3 } from "three";

import type { Frame } from "../wire/frames.ts";
import type { Phase, Vector } from "../wire/messages.generated.ts";
import { Arrow } from "./arrow.ts";
import { Mark } from "./mark.ts";
import { palette } from "./palette.ts";

const LENGTH = 0.4; // m, of the arrow

export class ContactMark {
  readonly group = new Group();
  readonly place = new Vector3();
  private readonly mark = new Mark(palette.contact);
  private readonly arrow = new Arrow(palette.contact, 0.018, LENGTH, 0);
  private text = "";

  constructor() {
    this.group.add(this.mark.group, this.arrow.group);
  }

  /** Shows the contact while it lasts, between two touches too; what touches. */
  update(frame: Frame, phases: readonly Phase[]): string {
    const part = frame.scalar("contact_part");
    if (part !== 0) this.touch(part, frame.vector("contact_point"), frame.vector("contact_normal"));
    else if (phases[frame.scalar("phase")] !== "contact") this.text = "";
    this.group.visible = this.text !== "";
    return this.text;
  }

  private touch(part: number, point: Vector, normal: Vector): void {
    this.place.set(...point);
    this.mark.show(this.place);
    this.arrow.show(this.place, normal);
    this.text = touching(part);
  }
}

/** What touches, by its number in a frame. */
export function touching(part: number): string {
  return part < 0 ? "the beam touches" : `guard ${part} touches`;
}
