/* The FMU of the mission "/*@NAME@*/": numbers by their value references, and saved states. */
#include "mission_fmu.h"

#include <stdlib.h>
#include <string.h>

#define COUNT (FMU_PARAMETERS + FMU_INPUTS + FMU_OUTPUTS)

/* The numbers of each array at its first reference, 0 elsewhere. */
static const uint16_t SIZE[COUNT] = {
/*@SIZES@*/
};

/* The address of a number, if it may be read or written now. */
static double *number(FmuInstance *instance, uint32_t reference, bool writes)
{
    FmuModel *model = &instance->model;
    const bool starts = model->mode == FMU_INSTANTIATED || model->mode == FMU_INITIALIZING;
    size_t at = (size_t)reference - 1;
    if (reference == 0 && !writes) {
        return &model->time;
    }
    if (reference == 0 || at >= COUNT) {
        fmu_report(instance, true, "value reference %lu: there is no such number that can be %s",
            (unsigned long)reference, writes ? "set" : "read");
        return 0;
    }
    if (at < FMU_PARAMETERS) {
        if (writes && !starts && !(model->mode == FMU_STEPPING && fmu_is_tunable((uint32_t)at))) {
            fmu_report(instance, true, "%s: is a parameter, and set before the end of initialization only",
                fmu_key((uint32_t)at));
            return 0;
        }
        model->is_tuned = model->is_tuned || (writes && !starts);
        return &model->parameters[at];
    }
    at -= FMU_PARAMETERS;
    if (at < FMU_INPUTS) {
        return &model->inputs[at];
    }
    if (writes) {
        fmu_report(instance, true, "value reference %lu: is an output, and cannot be set", (unsigned long)reference);
        return 0;
    }
    return fmu_update(instance) ? &model->outputs[at - FMU_INPUTS] : 0;
}

/* How many numbers a reference stands for; 0 after an error: it is within an array, or more than are left. */
static size_t size_of(FmuInstance *instance, uint32_t reference, int count, size_t left)
{
    const size_t size = count || reference == 0 ? 1 : reference <= COUNT ? SIZE[reference - 1] : 1;
    if (size == 0 || size > left) {
        fmu_report(instance, true, "value reference %lu: has %lu numbers, but %lu are given", (unsigned long)reference,
            (unsigned long)size, (unsigned long)left);
        return 0;
    }
    return size;
}

long fmu_get(FmuInstance *instance, const uint32_t references[], size_t n, int count, double values[], size_t size)
{
    size_t done = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t more = size_of(instance, references[i], count, size - done);
        const double *from = more ? number(instance, references[i], false) : 0;
        if (!from) {
            return -1;
        }
        memcpy(values + done, from, more * sizeof *values);
        done += more;
    }
    return (long)done;
}

long fmu_set(FmuInstance *instance, const uint32_t references[], size_t n, int count, const double values[], size_t size)
{
    size_t done = 0;
    for (size_t i = 0; i < n; i++) {
        const size_t more = size_of(instance, references[i], count, size - done);
        double *to = more ? number(instance, references[i], true) : 0;
        if (!to) {
            return -1;
        }
        if (memcmp(to, values + done, more * sizeof *values) != 0) {
            memcpy(to, values + done, more * sizeof *values);
            instance->model.is_current = false;
        }
        done += more;
    }
    return (long)done;
}

FmuModel *fmu_save(FmuInstance *instance)
{
    FmuModel *saved = malloc(sizeof *saved);
    if (saved) {
        *saved = instance->model;
    } else {
        fmu_report(instance, true, "GetFMUState: no memory is left");
    }
    return saved;
}

FmuResult fmu_restore(FmuInstance *instance, const FmuModel *saved)
{
    if (!saved) {
        fmu_report(instance, true, "SetFMUState: there is no state");
        return FMU_ERROR;
    }
    instance->model = *saved;
    return FMU_OK;
}

size_t fmu_bytes(void)
{
    return sizeof(FMU_TOKEN) + sizeof(FmuModel);
}

void fmu_pack(const FmuModel *saved, char *bytes)
{
    memcpy(bytes, FMU_TOKEN, sizeof(FMU_TOKEN));
    memcpy(bytes + sizeof(FMU_TOKEN), saved, sizeof *saved);
}

FmuModel *fmu_unpack(FmuInstance *instance, const char *bytes, size_t size)
{
    FmuModel *saved;
    if (size != fmu_bytes() || memcmp(bytes, FMU_TOKEN, sizeof(FMU_TOKEN)) != 0) {
        fmu_report(instance, true, "DeserializeFMUState: these are not the bytes of a state of this FMU");
        return 0;
    }
    saved = fmu_save(instance);
    if (saved) {
        memcpy(saved, bytes + sizeof(FMU_TOKEN), sizeof *saved);
    }
    return saved;
}
