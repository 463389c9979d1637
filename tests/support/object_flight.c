/* Flies an object of `tandemlift compile`: reads a job, calls prepare and fly, writes the log.
   The job is laid out by tests/codegen/test_objects.py: 64-bit integers, then doubles. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int64_t prepare(const double *numbers, double *prepared, double *work);
int64_t fly(int64_t *context);

enum {
    NUMBERS, PREPARED, FLIGHT, WORK, RING_ROWS, RING_ROW, SAMPLE, DELAYS, SPANS, STEPS, EVERY, ROWS, CONTEXT, WORDS,
    NAMED = 25
};

static void *room(size_t count) {
    double *memory = calloc(count + 8, sizeof(double));
    if (memory == NULL) exit(3);
    return memory;
}

static void read_all(void *to, size_t count, FILE *file) {
    if (fread(to, 8, count, file) != count) exit(4);
}

int main(int argc, char **argv) {
    const char *in = argc > 1 ? argv[1] : "job", *out = argc > 2 ? argv[2] : "log";
    int64_t n[WORDS], at[NAMED], tables[8];
    FILE *file = fopen(in, "rb");
    if (file == NULL) return 2;
    read_all(n, WORDS, file);
    read_all(at, NAMED, file); /* the places of the words that are set below, in this order */
    read_all(tables, 8, file);
    int64_t *spans = room((size_t)(2 * n[SPANS])), *delays = room((size_t)n[DELAYS]), *context = room((size_t)n[CONTEXT]);
    double *keys = room(2), dt, *numbers = room((size_t)n[NUMBERS]);
    read_all(spans, (size_t)(2 * n[SPANS]), file);
    read_all(delays, (size_t)n[DELAYS], file);
    read_all(keys, 2, file);
    read_all(&dt, 1, file);
    read_all(numbers, (size_t)n[NUMBERS], file);
    fclose(file);

    double *prepared = room((size_t)n[PREPARED]), *work = room((size_t)n[WORK]);
    if (prepare(numbers, prepared, work) != 0) return 5;
    memset(work, 0, 8 * (size_t)n[WORK]);
    double *ring = room((size_t)(n[RING_ROWS] * n[RING_ROW])), *to = ring;
    for (int64_t row = 0; row < n[RING_ROWS]; row++)
        for (int64_t i = 0; i < n[SPANS]; i++)
            for (int64_t j = 0; j < spans[2 * i + 1]; j++) *to++ = prepared[spans[2 * i] + j];
    double *log = room((size_t)(n[ROWS] * n[SAMPLE])), *last = room((size_t)n[SAMPLE]);
    const int64_t words[NAMED] = {
        (intptr_t)prepared, (intptr_t)work, (intptr_t)ring, (intptr_t)delays, (intptr_t)keys, (intptr_t)log,
        (intptr_t)last, (intptr_t)(prepared + tables[0]), (intptr_t)(prepared + tables[2]),
        (intptr_t)(prepared + tables[4]), (intptr_t)(prepared + tables[6]), tables[1], tables[3], tables[5], tables[7],
        n[RING_ROWS], n[ROWS] * n[SAMPLE], n[STEPS], n[EVERY], 0, 1, 0, 0, n[STEPS] + 1, -1,
    };
    for (int i = 0; i < NAMED; i++) context[at[i]] = words[i];
    memcpy(&context[at[21]], &dt, 8);
    fly(context);
    file = fopen(out, "wb");
    if (file == NULL || fwrite(log, 8, (size_t)(n[ROWS] * n[SAMPLE]), file) != (size_t)(n[ROWS] * n[SAMPLE])) return 6;
    return fclose(file) == 0 ? 0 : 7;
}
