/* The pilot of the mission "/*@NAME@*/": from a measurement to rotor thrusts.
 * Written by tandemlift /*@VERSION@*/ from a mission and laws with the hash /*@HASH@*/; see README.md. */
#ifndef MISSION_PILOT_H
#define MISSION_PILOT_H

#include "mission_checks.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MISSION_STEP /*@STEP@*/ /* s, from one sample to the next */
#define MISSION_ROTORS /*@ROTORS@*/

/*@TYPES@*/

/* The pilot before its first sample. */
void mission_pilot_start(mission_PilotData *pilot);

/* One sample. `input`: position [m], velocity [m/s], attitude quaternion w, x, y, z (body to world) and rates [rad/s]
 * in body axes of the centre of mass; force of the person [N] in world axes and moment [N m] in body axes about it; and
 * requests. `thrusts`: of every rotor [N].
//if refuses
 * False, and nothing done, if a number of the state, the force or the moment is not finite: the pilot keeps its memory,
 * `thrusts` keeps those of the last sample, and the time of the pilot stands still. This mission has no supervision. */
//end refuses
//if supervised
 * True: supervision detects numbers that are not finite, and uses none of them. */
//end supervised
bool mission_pilot_step(mission_PilotData *pilot, const mission_PilotInput *input, real thrusts[MISSION_ROTORS]);

#ifdef __cplusplus
}
#endif

#endif
