/* The functions of FMI 3.0 for co-simulation, on top of mission_fmu.h. */
#include "mission_fmu.h"

#include <stdlib.h>

/* Types and numbers of the standard. */
typedef void *Instance;
typedef uint32_t Reference;
typedef int Status;
enum { OK, WARNING, DISCARD, ERROR, FATAL };
typedef void Logger(void *environment, Status status, const char *category, const char *text);
typedef void Function(void); /* a callback without use here */
typedef const char *String;

static void send(FmuInstance *instance, bool is_error, const char *text)
{
    Logger *logger = (Logger *)instance->logger;
    if (logger) {
        logger(instance->environment, is_error ? ERROR : WARNING, is_error ? "logStatusError" : "logStatusWarning", text);
    }
}

static Status status_of(FmuResult result)
{
    return result == FMU_OK ? OK : result == FMU_DISCARD ? DISCARD : ERROR;
}

static Status refused(Instance c, const char *name)
{
    fmu_report(c, true, "%s: this FMU has no such thing", name);
    return ERROR;
}

/* The FMU and its life */

FMU_EXPORT const char *fmi3GetVersion(void)
{
    return "3.0";
}

FMU_EXPORT Status fmi3SetDebugLogging(Instance c, bool on, size_t n, const String categories[])
{
    (void)c, (void)on, (void)n, (void)categories; /* errors are always told, and there is nothing else to tell */
    return OK;
}

FMU_EXPORT Instance fmi3InstantiateCoSimulation(String name, String token, String resources, bool visible,
    bool logging, bool events, bool early_return, const Reference intermediate[], size_t intermediates,
    void *environment, Logger *logger, Function *update)
{
    const FmuInstance like = {.send = send, .environment = environment, .logger = (void (*)(void))logger};
    (void)resources, (void)visible, (void)logging, (void)events, (void)early_return;
    (void)intermediate, (void)intermediates, (void)update;
    return fmu_new(&like, name, token);
}

FMU_EXPORT Instance fmi3InstantiateModelExchange(String name, String token, String resources, bool visible,
    bool logging, void *environment, Logger *logger)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)logger;
    return 0;
}

FMU_EXPORT Instance fmi3InstantiateScheduledExecution(String name, String token, String resources, bool visible,
    bool logging, void *environment, Logger *logger, Function *clock, Function *lock, Function *unlock)
{
    (void)name, (void)token, (void)resources, (void)visible, (void)logging, (void)environment, (void)logger;
    (void)clock, (void)lock, (void)unlock;
    return 0;
}

FMU_EXPORT void fmi3FreeInstance(Instance c)
{
    free(c);
}

FMU_EXPORT Status fmi3EnterInitializationMode(Instance c, bool has_tolerance, double tolerance, double start,
    bool has_stop, double stop)
{
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    return status_of(fmu_initialize(c, start));
}

FMU_EXPORT Status fmi3ExitInitializationMode(Instance c)
{
    return status_of(fmu_begin(c));
}

FMU_EXPORT Status fmi3EnterStepMode(Instance c)
{
    (void)c;
    return OK;
}

FMU_EXPORT Status fmi3Terminate(Instance c)
{
    ((FmuInstance *)c)->model.mode = FMU_TERMINATED;
    return OK;
}

FMU_EXPORT Status fmi3Reset(Instance c)
{
    fmu_reset(c);
    return OK;
}

/* Numbers: an array is one reference */

FMU_EXPORT Status fmi3GetFloat64(Instance c, const Reference vr[], size_t n, double values[], size_t size)
{
    return fmu_get(c, vr, n, 0, values, size) < 0 ? ERROR : OK;
}

FMU_EXPORT Status fmi3SetFloat64(Instance c, const Reference vr[], size_t n, const double values[], size_t size)
{
    return fmu_set(c, vr, n, 0, values, size) < 0 ? ERROR : OK;
}

FMU_EXPORT Status fmi3GetBoolean(Instance c, const Reference vr[], size_t n, bool values[], size_t size)
{
    for (size_t i = 0; i < n; i++) {
        double x;
        if (i >= size || fmu_get(c, vr + i, 1, 1, &x, 1) < 0) {
            return ERROR;
        }
        values[i] = x != 0.0;
    }
    return OK;
}

FMU_EXPORT Status fmi3SetBoolean(Instance c, const Reference vr[], size_t n, const bool values[], size_t size)
{
    for (size_t i = 0; i < n; i++) {
        const double x = i < size && values[i] ? 1.0 : 0.0;
        if (i >= size || fmu_set(c, vr + i, 1, 1, &x, 1) < 0) {
            return ERROR;
        }
    }
    return OK;
}

#define NO_SUCH_TYPE(TYPE, KIND) \
    FMU_EXPORT Status fmi3Get##TYPE(Instance c, const Reference vr[], size_t n, KIND values[], size_t size) \
    { \
        (void)vr, (void)values, (void)size; \
        return n == 0 ? OK : refused(c, "fmi3Get" #TYPE); \
    } \
    FMU_EXPORT Status fmi3Set##TYPE(Instance c, const Reference vr[], size_t n, const KIND values[], size_t size) \
    { \
        (void)vr, (void)values, (void)size; \
        return n == 0 ? OK : refused(c, "fmi3Set" #TYPE); \
    }
NO_SUCH_TYPE(Float32, float)
NO_SUCH_TYPE(Int8, int8_t)
NO_SUCH_TYPE(UInt8, uint8_t)
NO_SUCH_TYPE(Int16, int16_t)
NO_SUCH_TYPE(UInt16, uint16_t)
NO_SUCH_TYPE(Int32, int32_t)
NO_SUCH_TYPE(UInt32, uint32_t)
NO_SUCH_TYPE(Int64, int64_t)
NO_SUCH_TYPE(UInt64, uint64_t)
NO_SUCH_TYPE(String, String)

/* Steps */

FMU_EXPORT Status fmi3DoStep(Instance c, double time, double size, bool is_final, bool *needs_events,
    bool *terminates, bool *returns_early, double *reached)
{
    FmuInstance *instance = c;
    const FmuResult result = fmu_step(instance, time, size);
    (void)is_final;
    *needs_events = false;
    *terminates = result != FMU_ERROR && fmu_is_over(instance);
    *returns_early = false;
    *reached = instance->model.time;
    return status_of(result);
}

/* States */

FMU_EXPORT Status fmi3GetFMUState(Instance c, void **state)
{
    FmuModel *saved = fmu_save(c);
    free(*state);
    *state = saved;
    return saved ? OK : ERROR;
}

FMU_EXPORT Status fmi3SetFMUState(Instance c, void *state)
{
    return status_of(fmu_restore(c, state));
}

FMU_EXPORT Status fmi3FreeFMUState(Instance c, void **state)
{
    (void)c;
    if (state) {
        free(*state);
        *state = 0;
    }
    return OK;
}

FMU_EXPORT Status fmi3SerializedFMUStateSize(Instance c, void *state, size_t *size)
{
    (void)c, (void)state;
    *size = fmu_bytes();
    return OK;
}

FMU_EXPORT Status fmi3SerializeFMUState(Instance c, void *state, uint8_t bytes[], size_t size)
{
    if (!state || size < fmu_bytes()) {
        return refused(c, "fmi3SerializeFMUState of too few bytes");
    }
    fmu_pack(state, (char *)bytes);
    return OK;
}

FMU_EXPORT Status fmi3DeserializeFMUState(Instance c, const uint8_t bytes[], size_t size, void **state)
{
    FmuModel *saved = fmu_unpack(c, (const char *)bytes, size);
    if (saved) {
        free(*state);
        *state = saved;
    }
    return saved ? OK : ERROR;
}

/* What the standard has besides: such functions are there, and refuse whatever their further arguments are. */

#define REFUSED(NAME) \
    FMU_EXPORT Status NAME(Instance c) \
    { \
        return refused(c, #NAME); \
    }
REFUSED(fmi3GetBinary)
REFUSED(fmi3SetBinary)
REFUSED(fmi3GetClock)
REFUSED(fmi3SetClock)
REFUSED(fmi3GetNumberOfVariableDependencies)
REFUSED(fmi3GetVariableDependencies)
REFUSED(fmi3GetDirectionalDerivative)
REFUSED(fmi3GetAdjointDerivative)
REFUSED(fmi3GetOutputDerivatives)
REFUSED(fmi3EnterConfigurationMode)
REFUSED(fmi3ExitConfigurationMode)
REFUSED(fmi3EnterEventMode)
REFUSED(fmi3GetIntervalDecimal)
REFUSED(fmi3GetIntervalFraction)
REFUSED(fmi3GetShiftDecimal)
REFUSED(fmi3GetShiftFraction)
REFUSED(fmi3SetIntervalDecimal)
REFUSED(fmi3SetIntervalFraction)
REFUSED(fmi3SetShiftDecimal)
REFUSED(fmi3SetShiftFraction)
REFUSED(fmi3EvaluateDiscreteStates)
REFUSED(fmi3UpdateDiscreteStates)
REFUSED(fmi3EnterContinuousTimeMode)
REFUSED(fmi3CompletedIntegratorStep)
REFUSED(fmi3SetTime)
REFUSED(fmi3SetContinuousStates)
REFUSED(fmi3GetContinuousStateDerivatives)
REFUSED(fmi3GetEventIndicators)
REFUSED(fmi3GetContinuousStates)
REFUSED(fmi3GetNominalsOfContinuousStates)
REFUSED(fmi3GetNumberOfEventIndicators)
REFUSED(fmi3GetNumberOfContinuousStates)
REFUSED(fmi3ActivateModelPartition)
