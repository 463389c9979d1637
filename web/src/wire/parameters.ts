// Values of parameters.

import type { ParameterValue, SceneParameter, Vector } from "./messages.generated.ts";

/** A parameter of three axes, which may be given as one number. */
export function perAxis(value: ParameterValue): Vector {
  return (Array.isArray(value) ? value : [value, value, value]) as unknown as Vector;
}

/** Parameters of which one has another value. */
export function withValue(parameters: SceneParameter[], key: string, value: ParameterValue): SceneParameter[] {
  return parameters.map((one) => (one.key === key ? { ...one, value } : one));
}

/** Whether two values, or two parts of a scene, are the same. */
export const same = (a: unknown, b: unknown): boolean => JSON.stringify(a) === JSON.stringify(b);
