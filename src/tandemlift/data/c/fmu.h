/* The functional mock-up unit (FMU) of the mission "/*@NAME@*/": an instance, for both versions of FMI. Written by
 * tandemlift /*@VERSION@*/ from a mission and laws with the hash /*@HASH@*/. */
#ifndef MISSION_FMU_H
#define MISSION_FMU_H

//if flight
#include "mission_flight_prepare.h"
//end flight
//if pilot
#include "mission_pilot_prepare.h"
//end pilot

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define FMU_TOKEN "/*@TOKEN@*/" /* of this description and these sources */
#define FMU_STEP /*@DOUBLE_STEP@*/ /* s, from one sample to the next: mission.step */
#define FMU_STEP_TOLERANCE 1e-6 /* of FMU_STEP: by so much the length of a step may be off a multiple of it */
#define FMU_TIME_TOLERANCE 0.5 /* of FMU_STEP: nearer to this sample than to others; sums of steps drift */
#define FMU_PARAMETERS /*@PARAMETERS@*/
#define FMU_INPUTS /*@INPUTS@*/
#define FMU_OUTPUTS /*@OUTPUTS@*/

/* The functions of an importer are seen from outside, and no others: FMUs with equal names share a process. */
#ifdef _WIN32
#define FMU_EXPORT __declspec(dllexport)
#else
#define FMU_EXPORT __attribute__((visibility("default")))
#endif

typedef enum { FMU_INSTANTIATED, FMU_INITIALIZING, FMU_STEPPING, FMU_TERMINATED, FMU_FAILED } FmuMode;
typedef enum { FMU_OK, FMU_DISCARD, FMU_ERROR } FmuResult;

/* All that changes: a copy of it is a saved state. Value references count from 1 over parameters, inputs, outputs;
 * 0 is the time. */
typedef struct {
    double parameters[FMU_PARAMETERS + 1]; /* as in mission_flight_numbers or mission_pilot_numbers */
    double inputs[FMU_INPUTS];
    double outputs[FMU_OUTPUTS];
    double time; /* s, reached so far */
    double start; /* s, at which the mission begins */
    int64_t steps; /* taken since then */
    FmuMode mode;
    bool is_current; /* whether the outputs are those of the present state and inputs */
    bool is_tuned; /* whether parameters were set since the last step */
//if flight
    mission_Prepared prepared;
    mission_Flight flight;
//end flight
//if pilot
    mission_PilotData pilot;
//end pilot
} FmuModel;

typedef struct FmuInstance FmuInstance;
struct FmuInstance {
    FmuModel model;
    void *environment; /* of the importer, handed to its logger */
    void (*logger)(void); /* of the importer */
    void (*send)(FmuInstance *instance, bool is_error, const char *text); /* calls the logger of a version of FMI */
    char name[128];
};

/* An instance with the logger of another, or a null pointer where the token is another one or no memory is left. */
FmuInstance *fmu_new(const FmuInstance *like, const char *name, const char *token);

/* The numbers of the mission, before initialization. */
void fmu_reset(FmuInstance *instance);

/* Begin initialization, with the mission's start at a time [s]; and end it: check the parameters and prepare. */
FmuResult fmu_initialize(FmuInstance *instance, double start);
FmuResult fmu_begin(FmuInstance *instance);

/* From the time of an importer by a step of its own [s], which must be on the grid of the mission's steps. Discarded from
 * the step on that cannot be taken: the flight is over, or an input is not finite. */
FmuResult fmu_step(FmuInstance *instance, double time, double size);

/* Whether no further step can be taken: the mission's duration is over, or the flight crashed or diverged. */
bool fmu_is_over(const FmuInstance *instance);

/* Compute the outputs of the present state and inputs, unless they are there. The key of a parameter. */
bool fmu_update(FmuInstance *instance);
const char *fmu_key(uint32_t parameter);

/* Whether a parameter may be set between steps. */
bool fmu_is_tunable(uint32_t parameter);

/* Read or write numbers: `count` for each reference, the size of the array there if it is 0. Returns how many numbers
 * were read or written, or −1 after an error. */
long fmu_get(FmuInstance *instance, const uint32_t references[], size_t n, int count, double values[], size_t size);
long fmu_set(FmuInstance *instance, const uint32_t references[], size_t n, int count, const double values[], size_t size);

/* A copy of the state, in memory that `free` releases; back to it; and from bytes, or a null pointer. */
FmuModel *fmu_save(FmuInstance *instance);
FmuResult fmu_restore(FmuInstance *instance, const FmuModel *saved);
size_t fmu_bytes(void);
void fmu_pack(const FmuModel *saved, char *bytes);
FmuModel *fmu_unpack(FmuInstance *instance, const char *bytes, size_t size);

/* A message to the importer: an error, or else a remark. */
void fmu_report(FmuInstance *instance, bool is_error, const char *format, ...);

#endif
