/* The pilot's numbers from those of the mission "/*@NAME@*/".
 * Written by tandemlift /*@VERSION@*/ from a mission and laws with the hash /*@HASH@*/; see README.md. */
#ifndef MISSION_PILOT_PREPARE_H
#define MISSION_PILOT_PREPARE_H

#include "mission_pilot.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Numbers of the mission, each by its key: unit, meaning, bounds. */
typedef struct {
/*@MEMBERS@*/
} mission_PilotNumbers;

extern const mission_PilotNumbers mission_pilot_numbers; /* as in the mission */

/* The pilot before its first sample. 0, or the number of the first condition that does not hold: then the numbers need
 * other code, and `prepared` is of no use. A condition depends on keys:
 * /*@GUARDS@*/ */
int mission_pilot_prepare(const mission_PilotNumbers *numbers, mission_PilotData *prepared);

#ifdef __cplusplus
}
#endif

#endif
