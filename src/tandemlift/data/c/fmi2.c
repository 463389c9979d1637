/* The functions of FMI 2.0 for co-simulation, on top of mission_fmu.h. */
#include "mission_fmu.h"

#include <stdlib.h>

/* Types and numbers of the standard. */
typedef void *Component;
typedef unsigned int Reference;
typedef int Status;
enum { OK, WARNING, DISCARD, ERROR, FATAL, PENDING };
enum { CO_SIMULATION = 1, LAST_SUCCESSFUL_TIME = 2, TERMINATED = 3 };
typedef void Logger(void *environment, const char *instance, Status status, const char *category, const char *text, ...);
typedef struct {
    Logger *logger;
    void *(*allocate)(size_t count, size_t size);
    void (*release)(void *memory);
    void (*step_finished)(void *environment, Status status);
    void *environment;
} Callbacks;

static Status status_of(FmuResult result)
{
    return result == FMU_OK ? OK : result == FMU_DISCARD ? DISCARD : ERROR;
}

static void send(FmuInstance *instance, bool is_error, const char *text)
{
    Logger *logger = (Logger *)instance->logger;
    if (logger) {
        logger(instance->environment, instance->name, is_error ? ERROR : DISCARD,
            is_error ? "logStatusError" : "logStatusDiscard", text);
    }
}

static Status refused(Component c, const char *name)
{
    fmu_report(c, true, "%s: this FMU has no such thing", name);
    return ERROR;
}

/* The FMU and its life */

FMU_EXPORT const char *fmi2GetTypesPlatform(void)
{
    return "default";
}

FMU_EXPORT const char *fmi2GetVersion(void)
{
    return "2.0";
}

FMU_EXPORT Status fmi2SetDebugLogging(Component c, int on, size_t n, const char *const categories[])
{
    (void)c, (void)on, (void)n, (void)categories; /* errors are always told, and there is nothing else to tell */
    return OK;
}

FMU_EXPORT Component fmi2Instantiate(const char *name, int type, const char *guid, const char *resources,
    const Callbacks *callbacks, int visible, int logging)
{
    FmuInstance like = {.send = send};
    (void)resources, (void)visible, (void)logging;
    if (callbacks) {
        like.environment = callbacks->environment;
        like.logger = (void (*)(void))callbacks->logger;
    }
    return type == CO_SIMULATION ? fmu_new(&like, name, guid) : 0;
}

FMU_EXPORT void fmi2FreeInstance(Component c)
{
    free(c);
}

FMU_EXPORT Status fmi2SetupExperiment(Component c, int has_tolerance, double tolerance, double start,
    int has_stop, double stop)
{
    FmuInstance *instance = c;
    (void)has_tolerance, (void)tolerance, (void)has_stop, (void)stop;
    instance->model.start = start;
    return OK;
}

FMU_EXPORT Status fmi2EnterInitializationMode(Component c)
{
    return status_of(fmu_initialize(c, ((FmuInstance *)c)->model.start));
}

FMU_EXPORT Status fmi2ExitInitializationMode(Component c)
{
    return status_of(fmu_begin(c));
}

FMU_EXPORT Status fmi2Terminate(Component c)
{
    ((FmuInstance *)c)->model.mode = FMU_TERMINATED;
    return OK;
}

FMU_EXPORT Status fmi2Reset(Component c)
{
    fmu_reset(c);
    return OK;
}

/* Numbers */

FMU_EXPORT Status fmi2GetReal(Component c, const Reference vr[], size_t n, double value[])
{
    return fmu_get(c, vr, n, 1, value, n) < 0 ? ERROR : OK;
}

FMU_EXPORT Status fmi2SetReal(Component c, const Reference vr[], size_t n, const double value[])
{
    return fmu_set(c, vr, n, 1, value, n) < 0 ? ERROR : OK;
}

FMU_EXPORT Status fmi2GetBoolean(Component c, const Reference vr[], size_t n, int value[])
{
    for (size_t i = 0; i < n; i++) {
        double x;
        if (fmu_get(c, vr + i, 1, 1, &x, 1) < 0) {
            return ERROR;
        }
        value[i] = x != 0.0;
    }
    return OK;
}

FMU_EXPORT Status fmi2SetBoolean(Component c, const Reference vr[], size_t n, const int value[])
{
    for (size_t i = 0; i < n; i++) {
        const double x = value[i] ? 1.0 : 0.0;
        if (fmu_set(c, vr + i, 1, 1, &x, 1) < 0) {
            return ERROR;
        }
    }
    return OK;
}

#define NO_SUCH_TYPE(TYPE, KIND) \
    FMU_EXPORT Status fmi2Get##TYPE(Component c, const Reference vr[], size_t n, KIND value[]) \
    { \
        (void)vr, (void)value; \
        return n == 0 ? OK : refused(c, "fmi2Get" #TYPE); \
    } \
    FMU_EXPORT Status fmi2Set##TYPE(Component c, const Reference vr[], size_t n, const KIND value[]) \
    { \
        (void)vr, (void)value; \
        return n == 0 ? OK : refused(c, "fmi2Set" #TYPE); \
    }
typedef const char *String;
NO_SUCH_TYPE(Integer, int)
NO_SUCH_TYPE(String, String)

/* Steps */

FMU_EXPORT Status fmi2DoStep(Component c, double time, double size, int is_final)
{
    (void)is_final;
    return status_of(fmu_step(c, time, size));
}

FMU_EXPORT Status fmi2CancelStep(Component c)
{
    return refused(c, "fmi2CancelStep");
}

FMU_EXPORT Status fmi2GetRealStatus(Component c, int kind, double *value)
{
    *value = ((FmuInstance *)c)->model.time;
    return kind == LAST_SUCCESSFUL_TIME ? OK : DISCARD;
}

FMU_EXPORT Status fmi2GetBooleanStatus(Component c, int kind, int *value)
{
    *value = kind == TERMINATED && fmu_is_over(c);
    return kind == TERMINATED ? OK : DISCARD;
}

FMU_EXPORT Status fmi2GetStatus(Component c, int kind, Status *value)
{
    (void)c, (void)kind;
    *value = OK;
    return DISCARD;
}

FMU_EXPORT Status fmi2GetIntegerStatus(Component c, int kind, int *value)
{
    (void)c, (void)kind;
    *value = 0;
    return DISCARD;
}

FMU_EXPORT Status fmi2GetStringStatus(Component c, int kind, const char **value)
{
    (void)c, (void)kind;
    *value = "";
    return DISCARD;
}

FMU_EXPORT Status fmi2SetRealInputDerivatives(Component c, const Reference vr[], size_t n, const int order[],
    const double value[])
{
    (void)vr, (void)n, (void)order, (void)value;
    return refused(c, "fmi2SetRealInputDerivatives");
}

FMU_EXPORT Status fmi2GetRealOutputDerivatives(Component c, const Reference vr[], size_t n, const int order[],
    double value[])
{
    (void)vr, (void)n, (void)order, (void)value;
    return refused(c, "fmi2GetRealOutputDerivatives");
}

FMU_EXPORT Status fmi2GetDirectionalDerivative(Component c, const Reference unknown[], size_t unknowns,
    const Reference known[], size_t knowns, const double change[], double result[])
{
    (void)unknown, (void)unknowns, (void)known, (void)knowns, (void)change, (void)result;
    return refused(c, "fmi2GetDirectionalDerivative");
}

/* States */

FMU_EXPORT Status fmi2GetFMUstate(Component c, void **state)
{
    FmuModel *saved = fmu_save(c);
    free(*state);
    *state = saved;
    return saved ? OK : ERROR;
}

FMU_EXPORT Status fmi2SetFMUstate(Component c, void *state)
{
    return status_of(fmu_restore(c, state));
}

FMU_EXPORT Status fmi2FreeFMUstate(Component c, void **state)
{
    (void)c;
    if (state) {
        free(*state);
        *state = 0;
    }
    return OK;
}

FMU_EXPORT Status fmi2SerializedFMUstateSize(Component c, void *state, size_t *size)
{
    (void)c, (void)state;
    *size = fmu_bytes();
    return OK;
}

FMU_EXPORT Status fmi2SerializeFMUstate(Component c, void *state, char bytes[], size_t size)
{
    if (!state || size < fmu_bytes()) {
        return refused(c, "fmi2SerializeFMUstate of too few bytes");
    }
    fmu_pack(state, bytes);
    return OK;
}

FMU_EXPORT Status fmi2DeSerializeFMUstate(Component c, const char bytes[], size_t size, void **state)
{
    FmuModel *saved = fmu_unpack(c, bytes, size);
    if (saved) {
        free(*state);
        *state = saved;
    }
    return saved ? OK : ERROR;
}

/* Functions of model exchange, which some importers look for: they refuse whatever their further arguments are. */

#define REFUSED(NAME) \
    FMU_EXPORT Status NAME(Component c) \
    { \
        return refused(c, #NAME); \
    }
REFUSED(fmi2EnterEventMode)
REFUSED(fmi2NewDiscreteStates)
REFUSED(fmi2EnterContinuousTimeMode)
REFUSED(fmi2CompletedIntegratorStep)
REFUSED(fmi2SetTime)
REFUSED(fmi2SetContinuousStates)
REFUSED(fmi2GetDerivatives)
REFUSED(fmi2GetEventIndicators)
REFUSED(fmi2GetContinuousStates)
REFUSED(fmi2GetNominalsOfContinuousStates)
