/* The flight of the mission "/*@NAME@*/", a function for each law. Written by tandemlift; see README.md. */
#include "mission_flight.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#ifdef __clang__
#pragma STDC FP_CONTRACT OFF
#endif

/*@TYPES@*/

/*@LAWS@*/
/*@TABLES@*/
static real time_of(int64_t k)
{
    return (real)((double)k * /*@DOUBLE_STEP@*/);
}

/* The sum of all pushes at the half steps of the span that begins with step `first`. */
static void sum_pushes(mission_Flight *flight, int64_t first)
{
    const real opens = time_of(first), closes = time_of(first + MISSION_SPAN);
    memset(flight->hands, 0, sizeof flight->hands);
    for (int64_t i = 0; i < flight->inputs.push_count; i++) {
        const GaussianPush *row = &flight->inputs.pushes[i];
        if (!/*@PUSH_IS_ACTIVE@*/) {
            continue;
        }
        for (int64_t j = 0; j <= 2 * MISSION_SPAN; j++) {
            const real when = (real)((double)(2 * first + j) * (/*@DOUBLE_STEP@*/ * 0.5));
            flight->hands[j] = /*@WITH_PUSH@*/;
        }
    }
}

//if gusts
/* The velocity of all gusts at time t. */
static Vec3 sum_gusts(const mission_Flight *flight, real t)
{
    Vec3 sum = {0, 0, 0};
    for (int64_t i = 0; i < flight->inputs.gust_count; i++) {
        sum = /*@WITH_GUST@*/;
    }
    return sum;
}

//end gusts
//if draws
/* The standard normals of step k. */
static StepNoise draw_noise(const mission_Flight *flight, int64_t k)
{
    const double *keys = flight->inputs.keys;
    double drawn[4 * /*@DRAWS@*/];
    real numbers[4 * /*@DRAWS@*/];
    StepNoise noise;
    for (int64_t i = 0; i < /*@DRAWS@*/; i++) {
        const /*@NORMALS@*/ four = /*@DRAW_NORMALS@*/;
        drawn[4 * i] = four.first;
        drawn[4 * i + 1] = four.second;
        drawn[4 * i + 2] = four.third;
        drawn[4 * i + 3] = four.fourth;
    }
    for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++) {
        numbers[i] = (real)drawn[i];
    }
    memcpy(&noise, numbers, sizeof noise);
    return noise;
}

//end draws
//if surroundings
/* Whether the floor is near, and the leg of the person's path. */
static void find_surroundings(mission_Flight *flight)
{
    FlightModel *model = &flight->model;
//if floor
    flight->low = /*@FLOOR_IS_NEAR@*/;
//end floor
//if person
    {
        const double number = (double)model->flight_state.person.index;
        const int64_t last = flight->inputs.leg_count - 1;
        const int64_t wanted = number >= (double)last ? last : number >= 0.0 ? (int64_t)number : 0;
        model->flight_state.person.leg = flight->inputs.legs[wanted];
    }
//end person
}

//end surroundings
//if walls
/* The nearest walls, at the start of a span of steps and, of a vehicle that is fast, in every step. */
static void find_walls(mission_Flight *flight, bool begins)
{
    FlightModel *model = &flight->model;
    if (begins || /*@WALLS_ARE_DUE@*/) {
        model->flight_state.near = NOWHERE;
        for (int64_t i = 0; i < flight->inputs.wall_count; i++) {
            model->flight_state.near = /*@NEAREST_WALLS@*/;
        }
    }
}

//end walls
//if delays
/* Exchange the delayed parts of the flight with the delay lines after step k. */
static void exchange_delayed(mission_Flight *flight, int64_t k)
{
    static const struct { size_t at, size; int64_t ahead; } PARTS[MISSION_DELAYS] = {/*@PARTS@*/};
    const int64_t mask = MISSION_RING_ROWS - 1;
    char *numbers = (char *)&flight->model;
    size_t column = 0;
    for (int j = 0; j < MISSION_DELAYS; j++) {
        const size_t bytes = PARTS[j].size * sizeof(real);
        const int64_t from = (k + PARTS[j].ahead - flight->inputs.delays[j]) & mask;
        if (bytes > 0) {
            char *part = numbers + PARTS[j].at * sizeof(real);
            memcpy(&flight->ring[k & mask][column], part, bytes);
            memcpy(part, &flight->ring[from][column], bytes);
            column += PARTS[j].size;
        }
    }
}

//end delays
void mission_flight_start_from(mission_Flight *flight, const mission_FlightModel *model, const mission_Inputs *inputs)
{
    memset(flight, 0, sizeof *flight);
    flight->model = *model;
    flight->inputs = *inputs;
//if delays
    {
        static const struct { size_t at, size; } PARTS[MISSION_DELAYS] = {/*@PLACES@*/};
        size_t column = 0;
        for (int j = 0; j < MISSION_DELAYS; j++) {
            const char *part = (const char *)model + PARTS[j].at * sizeof(real);
            for (int row = 0; row < MISSION_RING_ROWS && PARTS[j].size > 0; row++) {
                memcpy(&flight->ring[row][column], part, PARTS[j].size * sizeof(real));
            }
            column += PARTS[j].size;
        }
    }
//end delays
}

void mission_flight_mission(mission_FlightModel *model, mission_Inputs *inputs)
{
    *model = START;
    *inputs = INPUTS;
}

void mission_flight_start(mission_Flight *flight)
{
    mission_flight_start_from(flight, &START, &INPUTS);
}

/* What step k does from the present state: the state after it, and the sample at its start. The flight stays, but for
 * what was found around it. */
static FlightState evaluate(mission_Flight *flight, const CallerInput *external, Sample *sample)
{
    const int64_t k = flight->k, in_span = k % MISSION_SPAN;
    const real t = time_of(k);
    PushSamples hand;
    if (in_span == 0) {
        sum_pushes(flight, k);
//if surroundings
        find_surroundings(flight);
//end surroundings
    }
//if walls
    find_walls(flight, in_span == 0);
//end walls
    hand.start = flight->hands[2 * in_span];
    hand.middle = flight->hands[2 * in_span + 1];
    hand.end = flight->hands[2 * in_span + 2];
    {
//if gusts
        const Vec3 gust = sum_gusts(flight, t);
//end gusts
//if draws
        const StepNoise noise = draw_noise(flight, k);
//end draws
        return advance_flight(&flight->model, &hand, external, /*@ARGUMENTS@*/t, MISSION_FLIGHT_STEP, sample);
    }
}

bool mission_flight_is_over(const mission_Flight *flight)
{
    return flight->over || flight->model.flight_state.ended != 0;
}

bool mission_flight_look(mission_Flight *flight, const mission_CallerInput *external, mission_Sample *sample)
{
    static const CallerInput NONE;
    if (mission_flight_is_over(flight)) {
        return false;
    }
    (void)evaluate(flight, external ? external : &NONE, sample);
    return true;
}

bool mission_flight_step_with(mission_Flight *flight, const mission_CallerInput *external, mission_Sample *sample)
{
    static const CallerInput NONE;
    const int64_t k = flight->k;
    Sample sampled;
    FlightState after;
    if (mission_flight_is_over(flight)) {
        flight->over = true;
        return false;
    }
    after = evaluate(flight, external ? external : &NONE, &sampled);
    if (sample) {
        *sample = sampled;
    }
//if ends
    if (k == MISSION_FLIGHT_STEPS) {
        flight->over = true;
        return true;
    }
//end ends
    flight->model.flight_state = after;
//if delays
    exchange_delayed(flight, k);
//end delays
    flight->k = k + 1;
    return true;
}

bool mission_flight_step(mission_Flight *flight, mission_Sample *sample)
{
    return mission_flight_step_with(flight, 0, sample);
}
