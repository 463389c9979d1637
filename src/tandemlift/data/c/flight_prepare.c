/* The flight's numbers from those of the mission "/*@NAME@*/". Written by tandemlift; see README.md. */
#include "mission_flight_prepare.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

const mission_FlightNumbers mission_flight_numbers = {
/*@VALUES@*/
};

/*@LAWS@*/
int mission_flight_prepare(const mission_FlightNumbers *numbers, mission_Prepared *prepared)
{
    int failed = 0;
    mission_flight_mission(&prepared->model, &prepared->inputs);
/*@COPIES@*/
    prepare(numbers, prepared, &failed);
    return failed;
}
