/* The FMU of the mission "/*@NAME@*/": parameters, steps and states, alike for both versions of FMI. */
#include "mission_fmu.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Inputs before an importer sets them, and their names. */
static const double INPUT[FMU_INPUTS] = {/*@STARTS@*/};
static const char *const INPUT_NAME[FMU_INPUTS] = {
/*@NAMES@*/
};
//if flight

/* The place of each output in a sample. */
static const uint16_t PLACE[FMU_OUTPUTS] = {/*@PLACES@*/};
//end flight

/* Parameters by their keys: bounds, whether these are open, and whether it may be set between steps. */
static const struct {
    const char *key;
    double least, most;
    bool above, below, is_tunable;
} PARAMETER[FMU_PARAMETERS + 1] = {
/*@BOUNDS@*/
    {"", 0.0, 0.0, false, false, false}
};

/* The keys of each condition under which this code is that of the mission. */
static const char *const GUARD[] = {
/*@GUARDS@*/
    ""
};

void fmu_report(FmuInstance *instance, bool is_error, const char *format, ...)
{
    char text[1024];
    va_list given;
    va_start(given, format);
    vsnprintf(text, sizeof text, format, given);
    va_end(given);
    for (char *c = text; *c; c++) { /* a logger of FMI 2 takes it for a format */
        *c = *c == '%' ? '?' : *c;
    }
    instance->send(instance, is_error, text);
}

/* Whether all inputs are finite; else the first one that is not is reported. */
static bool are_finite(FmuInstance *instance, bool is_error)
{
    for (int i = 0; i < FMU_INPUTS; i++) {
        if (!isfinite(instance->model.inputs[i])) {
//if pilot
            fmu_report(instance, is_error,
                "at %.17g s, %s = %g is not finite: without supervision the pilot takes no such sample",
                instance->model.time, INPUT_NAME[i], instance->model.inputs[i]);
//end pilot
//if flight
            fmu_report(instance, is_error, "at %.17g s, %s = %g is not finite: no step can be taken with it",
                instance->model.time, INPUT_NAME[i], instance->model.inputs[i]);
//end flight
            return false;
        }
    }
    return true;
}

static FmuResult failed(FmuInstance *instance)
{
    instance->model.mode = FMU_FAILED;
    return FMU_ERROR;
}

FmuInstance *fmu_new(const FmuInstance *like, const char *name, const char *token)
{
    FmuInstance *instance = malloc(sizeof *instance);
    if (!instance) {
        return 0;
    }
    *instance = *like;
    snprintf(instance->name, sizeof instance->name, "%s", name ? name : "");
    if (!token || strcmp(token, FMU_TOKEN) != 0) {
        fmu_report(instance, true, "instantiation: the token is %s, but this library is that of " FMU_TOKEN,
            token ? token : "none");
        free(instance);
        return 0;
    }
    fmu_reset(instance);
    return instance;
}

void fmu_reset(FmuInstance *instance)
{
    FmuModel *model = &instance->model;
    memset(model, 0, sizeof *model);
    memcpy(model->parameters, &mission_/*@PART@*/_numbers, sizeof(double) * FMU_PARAMETERS);
    memcpy(model->inputs, INPUT, sizeof INPUT);
}

//if flight
/* Point to the tables of this copy. */
static void bind(FmuModel *model)
{
    mission_Prepared *prepared = &model->prepared;
/*@COPIES@*/
    model->flight.inputs = prepared->inputs;
}

//end flight
/* Whether all parameters are within their bounds. */
static bool are_allowed(FmuInstance *instance)
{
    for (int i = 0; i < FMU_PARAMETERS; i++) {
        const double x = instance->model.parameters[i], least = PARAMETER[i].least, most = PARAMETER[i].most;
        const bool low = PARAMETER[i].above ? x > least : x >= least;
        const bool high = PARAMETER[i].below ? x < most : x <= most;
        if (!(low && high)) {
            fmu_report(instance, true, "%s = %.17g: must be %s %.17g and %s %.17g", PARAMETER[i].key, x,
                PARAMETER[i].above ? ">" : ">=", least, PARAMETER[i].below ? "<" : "<=", most);
            return false;
        }
    }
    return true;
}

/* The numbers of the code from the parameters: before the first step, or of the steps to come. */
static bool prepare(FmuInstance *instance)
{
    FmuModel *model = &instance->model;
    /*@NUMBERS@*/ numbers;
    int wrong;
//if pilot
    const mission_PilotData before = model->pilot;
//end pilot
    if (!are_allowed(instance)) {
        return false;
    }
    memcpy(&numbers, model->parameters, sizeof(double) * FMU_PARAMETERS);
//if flight
    wrong = mission_flight_prepare(&numbers, &model->prepared);
//end flight
//if pilot
    wrong = mission_pilot_prepare(&numbers, &model->pilot);
//end pilot
    if (wrong) {
        fmu_report(instance, true, "%s: the values need other code; write an FMU of a mission that has them",
            GUARD[wrong - 1]);
        return false;
    }
//if flight
    if (model->mode == FMU_STEPPING) {
        model->prepared.model.flight_state = model->flight.model.flight_state;
        model->flight.model = model->prepared.model;
    } else {
        mission_flight_start_from(&model->flight, &model->prepared.model, &model->prepared.inputs);
    }
//end flight
//if pilot
    if (model->mode == FMU_STEPPING) {
        model->pilot.samples = before.samples;
        model->pilot.memory = before.memory;
    }
//end pilot
    model->is_current = model->is_tuned = false;
    return true;
}

FmuResult fmu_initialize(FmuInstance *instance, double start)
{
    FmuModel *model = &instance->model;
    if (model->mode != FMU_INSTANTIATED || !isfinite(start)) {
        fmu_report(instance, true, "EnterInitializationMode: once after instantiation or reset, at a finite time");
        return failed(instance);
    }
    model->mode = FMU_INITIALIZING;
    model->start = model->time = start;
    return FMU_OK;
}

const char *fmu_key(uint32_t parameter)
{
    return PARAMETER[parameter].key;
}

bool fmu_is_tunable(uint32_t parameter)
{
    return PARAMETER[parameter].is_tunable;
}

//if flight
static void put_outputs(FmuModel *model, const mission_Sample *sample)
{
    for (int i = 0; i < FMU_OUTPUTS; i++) {
        memcpy(&model->outputs[i], (const char *)sample + PLACE[i] * sizeof(double), sizeof(double));
    }
}

//end flight
bool fmu_update(FmuInstance *instance)
{
    FmuModel *model = &instance->model;
    if (model->is_current || model->mode == FMU_INSTANTIATED) {
        return true;
    }
    if ((model->mode == FMU_INITIALIZING || model->is_tuned) && !prepare(instance)) {
        return false;
    }
//if flight
    {
        mission_Sample sample;
        mission_CallerInput external;
        if (model->mode == FMU_INITIALIZING && !are_finite(instance, true)) {
            return false;
        }
        memcpy(&external, model->inputs, sizeof external);
        bind(model);
        if (mission_flight_look(&model->flight, &external, &sample)) {
            put_outputs(model, &sample);
        }
    }
//end flight
//if pilot
    if (model->mode == FMU_INITIALIZING) { /* afterwards, a step decides */
        mission_PilotData pilot = model->pilot;
        mission_PilotInput input;
        memcpy(&input, model->inputs, sizeof input);
        if (!mission_pilot_step(&pilot, &input, model->outputs)) {
            are_finite(instance, true);
            return false;
        }
    }
//end pilot
    model->is_current = true;
    return true;
}

FmuResult fmu_begin(FmuInstance *instance)
{
    if (instance->model.mode != FMU_INITIALIZING) {
        fmu_report(instance, true, "ExitInitializationMode: only in initialization mode");
        return failed(instance);
    }
    if (!fmu_update(instance)) {
        return failed(instance);
    }
    instance->model.mode = FMU_STEPPING;
    return FMU_OK;
}

/* One step of the mission. False, and nothing done, if a pilot is given numbers that are not finite. */
static bool advance(FmuModel *model)
{
//if flight
    mission_Sample sample;
    mission_CallerInput external;
    memcpy(&external, model->inputs, sizeof external);
    bind(model);
    if (mission_flight_step_with(&model->flight, &external, &sample) && mission_flight_is_over(&model->flight)) {
        put_outputs(model, &sample); /* no further sample can be looked at */
    }
    return true;
//end flight
//if pilot
    mission_PilotInput input;
    memcpy(&input, model->inputs, sizeof input);
    return mission_pilot_step(&model->pilot, &input, model->outputs);
//end pilot
}

FmuResult fmu_step(FmuInstance *instance, double time, double size)
{
    FmuModel *model = &instance->model;
    const double wanted = size / FMU_STEP, count = floor(wanted + 0.5);
    const double here = (time - model->start) / FMU_STEP;
    if (model->mode != FMU_STEPPING) {
        fmu_report(instance, true, "DoStep: only after initialization, and not after an error");
        return failed(instance);
    }
    if (!(fabs(wanted - count) <= FMU_STEP_TOLERANCE && count >= 1.0 && count < 1e15)) {
        fmu_report(instance, true,
            "step-off-sample-time: a step of %.17g s is no multiple of mission.step = %.17g s (within %g of it)", size,
            FMU_STEP, FMU_STEP_TOLERANCE);
        return failed(instance);
    }
    if (!(fabs(here - (double)model->steps) < FMU_TIME_TOLERANCE)) {
        fmu_report(instance, true,
            "step-off-sample-time: a step from %.17g s, but %.17g s are reached (within %g of mission.step = %.17g s)",
            time, model->time, FMU_TIME_TOLERANCE, FMU_STEP);
        return failed(instance);
    }
    if (model->is_tuned && !prepare(instance)) {
        return failed(instance);
    }
    for (int64_t left = (int64_t)count; left > 0; left--) {
        if (fmu_is_over(instance)) {
            fmu_report(instance, false, "the flight is over since %.17g s: by mission.duration, a crash or divergence",
                model->time);
            return FMU_DISCARD;
        }
//if flight
        if (!are_finite(instance, false)) {
            return FMU_DISCARD;
        }
//end flight
        if (!advance(model)) {
//if pilot
            are_finite(instance, false);
//end pilot
            return FMU_DISCARD;
        }
        model->steps++;
        model->time = model->start + (double)model->steps * FMU_STEP;
        model->is_current = false;
    }
    return FMU_OK;
}

bool fmu_is_over(const FmuInstance *instance)
{
//if flight
    const mission_Flight *flight = &instance->model.flight;
    return mission_flight_is_over(flight)/*@ENDS@*/;
//end flight
//if pilot
    (void)instance; /* a pilot goes on */
    return false;
//end pilot
}
