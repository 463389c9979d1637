// The bounds of what a page may say. As `live.session.page_messages` has them.

import type { PageMessage } from "../wire/messages.generated.ts";
import type { FieldRule, PageManifest } from "./manifest.ts";
import { Refusal, shown } from "./refusal.ts";

/** Refuses a message with numbers out of bounds, or with a name that no file may have. */
export function checkMessage(message: PageMessage, page: PageManifest): void {
  if (message.type === "save" && !new RegExp(`^(?:${page.save_name})$`).test(message.name)) {
    throw new Refusal(page.texts.name, { value: shown(message.name) });
  }
  const values = message as unknown as Record<string, unknown>;
  for (const [field, rule] of Object.entries(page.rules[message.type] ?? {})) check(field, rule, values[field]);
}

function check(field: string, rule: FieldRule, given: unknown): void {
  const entry = rule.count > 0;
  [given].flat().forEach((value: unknown, i) => {
    if (typeof value !== "number" || (value >= rule.min && value <= rule.max)) return;
    throw new Refusal(rule.wrong, { key: entry ? `${field}.${i}` : field, value: shown(entry ? value : given) });
  });
}
