/* The flight's numbers from those of the mission "/*@NAME@*/".
 * Written by tandemlift /*@VERSION@*/ from a mission and laws with the hash /*@HASH@*/; see README.md. */
#ifndef MISSION_FLIGHT_PREPARE_H
#define MISSION_FLIGHT_PREPARE_H

#include "mission_flight.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Numbers of the mission, each by its key: unit, meaning, bounds. */
typedef struct {
/*@MEMBERS@*/
} mission_FlightNumbers;

extern const mission_FlightNumbers mission_flight_numbers; /* as in the mission */

/* A flight before its first step, for mission_flight_start_from(flight, &prepared->model, &prepared->inputs). */
typedef struct {
    mission_FlightModel model;
/*@TABLES@*/
    mission_Inputs inputs;
} mission_Prepared;

/* 0, or the number of the first condition that does not hold: then the numbers need other code, and `prepared` is of no
 * use. A condition depends on keys:
 * /*@GUARDS@*/ */
int mission_flight_prepare(const mission_FlightNumbers *numbers, mission_Prepared *prepared);

#ifdef __cplusplus
}
#endif

#endif
