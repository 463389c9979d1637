// Why a message is refused; the texts come from Python.

import { filled } from "./python_text.ts";

export class Refusal extends Error {
  constructor(text: string, values: Record<string, string> = {}) {
    super(filled(text, values));
  }
}
