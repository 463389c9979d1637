/* The pilot of the mission "/*@NAME@*/", a function for each law. Written by tandemlift; see README.md. */
#include "mission_pilot.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

/*@TYPES@*/

/*@LAWS@*/
void mission_pilot_start(mission_PilotData *pilot)
{
    *pilot = START;
}

bool mission_pilot_step(mission_PilotData *pilot, const mission_PilotInput *input, real thrusts[MISSION_ROTORS])
{
    /*@SET@*/ wanted;
//if refuses
    const real zero = /*@ZERO@*/; /* or NaN */
    if (!(zero == 0)) {
        return false; /* the memory would never be finite again */
    }
//end refuses
    sample(pilot, input, MISSION_STEP, &wanted);
    memcpy(thrusts, wanted.r, sizeof wanted.r);
    return true;
}
