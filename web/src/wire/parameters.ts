// Values of parameters.

import type { ParameterValue, Vector } from "./messages.generated.ts";

/** A parameter of three axes, which may be given as one number. */
export function perAxis(value: ParameterValue): Vector {
  return (Array.isArray(value) ? value : [value, value, value]) as unknown as Vector;
}
