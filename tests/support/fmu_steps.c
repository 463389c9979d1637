/* Steps an FMU of any system and writes numbers after each step: fmu_steps FMI LIBRARY TOKEN STEP STEPS NUMBERS OUT REF...
 *
 * FMI is 2 or 3, NUMBERS how many numbers the variables with the value references REF have together. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#ifdef _WIN32
#include <windows.h>
#define OPEN(path) (void *)LoadLibraryA(path)
#define FIND(library, name) (void *)GetProcAddress((HMODULE)(library), name)
#else
#include <dlfcn.h>
#define OPEN(path) dlopen(path, RTLD_NOW)
#define FIND(library, name) dlsym(library, name)
#endif

static void *library;

static void *function(const char *prefix, const char *name)
{
    char whole[64];
    snprintf(whole, sizeof whole, "%s%s", prefix, name);
    void *found = FIND(library, whole);
    if (!found) {
        fprintf(stderr, "%s is missing\n", whole);
        exit(3);
    }
    return found;
}

static void check(int status, const char *what)
{
    if (status) {
        fprintf(stderr, "%s: status %d\n", what, status);
        exit(4);
    }
}

static void log2_(void *e, const char *n, int s, const char *c, const char *text, ...) { fprintf(stderr, "%s\n", text); }
static void log3_(void *e, int s, const char *c, const char *text) { fprintf(stderr, "%s\n", text); }

typedef struct {
    void (*log)(void *, const char *, int, const char *, const char *, ...);
    void *(*allocate)(size_t, size_t);
    void (*release)(void *);
    void *finished, *environment;
} Callbacks;

int main(int count, char **given)
{
    if (count < 9)
        return 2;
    bool two = atoi(given[1]) == 2;
    const char *prefix = two ? "fmi2" : "fmi3", *token = given[3];
    double size = atof(given[4]), reached, *values;
    long steps = atol(given[5]), numbers = atol(given[6]), n = count - 8;
    uint32_t *references = calloc(n, sizeof *references);
    for (long i = 0; i < n; i++)
        references[i] = strtoul(given[8 + i], NULL, 10);
    values = calloc(numbers, sizeof *values);
    FILE *out = fopen(given[7], "wb");
    library = OPEN(given[2]);
    if (!library || !out) {
        fprintf(stderr, "cannot open %s or %s\n", given[2], given[7]);
        return 3;
    }
    static Callbacks callbacks = {log2_, calloc, free, NULL, NULL};
    void *one = two ? ((void *(*)(const char *, int, const char *, const char *, Callbacks *, int, int))
                           function(prefix, "Instantiate"))("one", 1, token, "", &callbacks, 0, 0)
                    : ((void *(*)(const char *, const char *, const char *, bool, bool, bool, bool, void *, size_t, void *,
                                  void *, void *))function(prefix, "InstantiateCoSimulation"))(
                          "one", token, "", false, false, false, false, NULL, 0, NULL, (void *)log3_, NULL);
    if (!one)
        return 5;
    if (two) {
        check(((int (*)(void *, int, double, double, int, double))function(prefix, "SetupExperiment"))(one, 0, 0, 0, 0, 0),
              "setup");
        check(((int (*)(void *))function(prefix, "EnterInitializationMode"))(one), "enter");
    } else
        check(((int (*)(void *, bool, double, double, bool, double))function(prefix, "EnterInitializationMode"))(
                  one, false, 0, 0, false, 0),
              "enter");
    check(((int (*)(void *))function(prefix, "ExitInitializationMode"))(one), "exit");
    void *get = function(prefix, two ? "GetReal" : "GetFloat64"), *step = function(prefix, "DoStep");
    for (long k = 0; k <= steps; k++) {
        bool flags[3];
        if (k > 0 && two)
            check(((int (*)(void *, double, double, int))step)(one, (k - 1) * size, size, 1), "step");
        else if (k > 0)
            check(((int (*)(void *, double, double, bool, bool *, bool *, bool *, double *))step)(
                      one, (k - 1) * size, size, true, flags, flags + 1, flags + 2, &reached),
                  "step");
        if (two)
            check(((int (*)(void *, const uint32_t *, size_t, double *))get)(one, references, n, values), "get");
        else
            check(((int (*)(void *, const uint32_t *, size_t, double *, size_t))get)(one, references, n, values, numbers),
                  "get");
        fwrite(values, sizeof *values, numbers, out);
    }
    return fclose(out);
}
