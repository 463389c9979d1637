/* The pilot's numbers from those of the mission "/*@NAME@*/". Written by tandemlift; see README.md. */
#include "mission_pilot_prepare.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

const mission_PilotNumbers mission_pilot_numbers = {
/*@VALUES@*/
};

/*@LAWS@*/
int mission_pilot_prepare(const mission_PilotNumbers *numbers, mission_PilotData *prepared)
{
    int failed = 0;
    mission_pilot_start(prepared);
    prepare(numbers, prepared, &failed);
    return failed;
}
