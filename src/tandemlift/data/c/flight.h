/* The flight of the mission "/*@NAME@*/": pilot, rotors, sensors, body, person.
 * Written by tandemlift /*@VERSION@*/ from a mission and laws with the hash /*@HASH@*/; see README.md. */
#ifndef MISSION_FLIGHT_H
#define MISSION_FLIGHT_H

#include "mission_checks.h"

#include <stdbool.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#define MISSION_FLIGHT_STEP /*@STEP@*/ /* s */
#define MISSION_FLIGHT_STEPS /*@STEPS@*/ /* of the mission */
#define MISSION_FLIGHT_EVERY /*@EVERY@*/ /* steps from one logged sample to the next */
#define MISSION_SPAN 16 /* steps for which pushes are summed and surroundings searched at once */
//if delays
#define MISSION_RING_ROWS /*@RING_ROWS@*/ /* of the delay lines, a power of two */
#define MISSION_RING_WIDTH /*@RING_WIDTH@*/
#define MISSION_DELAYS /*@DELAYS@*/ /* delayed parts of a flight */
//end delays

/*@TYPES@*/

/* The inputs of a flight from outside. `keys`: of its random numbers; delays in steps, of each delayed part. */
typedef struct {
    const mission_GaussianPush *pushes;
    int64_t push_count;
//if gusts
    const mission_Gust *gusts;
    int64_t gust_count;
//end gusts
//if walls
    const mission_Wall *walls;
    int64_t wall_count;
//end walls
//if person
    const mission_PathLeg *legs;
    int64_t leg_count;
//end person
//if delays
    int64_t delays[MISSION_DELAYS];
//end delays
    double keys[2];
} mission_Inputs;

/* A flight in progress. */
typedef struct {
    mission_FlightModel model;
    mission_Inputs inputs;
    int64_t k;
    bool over;
    bool low;
    mission_/*@PUSH@*/ hands[2 * MISSION_SPAN + 1];
//if delays
    real ring[MISSION_RING_ROWS][MISSION_RING_WIDTH];
//end delays
} mission_Flight;

/* The mission's flight before its first step. */
void mission_flight_start(mission_Flight *flight);

/* The numbers of the mission, and its inputs. */
void mission_flight_mission(mission_FlightModel *model, mission_Inputs *inputs);

/* A flight of other numbers before its first step; `inputs` must outlive it. */
void mission_flight_start_from(mission_Flight *flight, const mission_FlightModel *model, const mission_Inputs *inputs);

/* One step: the sample at its start is written to `sample`, unless it is a null pointer. False, and nothing done, once
 * the flight is over: after MISSION_FLIGHT_STEPS steps and one more sample, or where it crashes or diverges. */
bool mission_flight_step(mission_Flight *flight, mission_Sample *sample);

/* The same with inputs of a caller, which are held over the step: a force at a point, beside the mission's pushes;
 * thrusts in place of the pilot's, if `override` is 1; and a velocity of the reference, if `lead.given` is 1. */
bool mission_flight_step_with(mission_Flight *flight, const mission_CallerInput *external, mission_Sample *sample);

/* The sample that the next step will have with these inputs; the flight does not advance. False once it is over. */
bool mission_flight_look(mission_Flight *flight, const mission_CallerInput *external, mission_Sample *sample);

/* Whether the flight is over. */
bool mission_flight_is_over(const mission_Flight *flight);

#ifdef __cplusplus
}
#endif

#endif
