/* The whole flight of the mission "/*@NAME@*/" beside stored samples. */
#include "mission_flight.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define ROWS /*@ROWS@*/
#define NUMBERS (sizeof(mission_Sample) / sizeof(real))

/* Logged samples: at which step, and the numbers of each. */
static const int64_t STEP_OF[ROWS] = {/*@STEPS_OF@*/};
static const real ROW[ROWS][/*@COLUMNS@*/] = {
/*@DATA@*/
};
//if double

/* A sum over the bits of all numbers of all logged samples, each times an odd weight; NaN counts as one number. */
static uint64_t sum_of(const real *numbers, uint64_t place)
{
    uint64_t sum = 0;
    for (size_t i = 0; i < NUMBERS; i++) {
        uint64_t bits;
        memcpy(&bits, &numbers[i], sizeof bits);
        sum += (numbers[i] == numbers[i] ? bits : UINT64_C(0x7FF8000000000000)) * (2 * (place + i) + 1);
    }
    return sum;
}
//end double

int main(void)
{
    static mission_Flight flight;
    mission_Sample sample;
    real numbers[NUMBERS];
    int row = 0, wrong = 0;
    int64_t k = 0;
//if double
    uint64_t sum = 0;
    uint64_t place = 0;
//end double
    mission_flight_start(&flight);
    for (; mission_flight_step(&flight, &sample); k++) {
        if (k % MISSION_FLIGHT_EVERY != 0) {
            continue;
        }
        memcpy(numbers, &sample, sizeof sample);
//if double
        sum += sum_of(numbers, place);
        place += NUMBERS;
//end double
        if (row < ROWS && STEP_OF[row] == k) {
//if double
            for (size_t i = 0; i < NUMBERS; i++) {
                const real wanted = ROW[row][i];
                const int both_nan = numbers[i] != numbers[i] && wanted != wanted;
                wrong += !both_nan && memcmp(&numbers[i], &wanted, sizeof wanted) != 0;
            }
//end double
//if single
            for (size_t i = 0; i < 3; i++) {
                wrong += !(fabsf(numbers[i] - ROW[row][i]) <= 0.05f); /* m, of the position */
            }
//end single
            row++;
        }
    }
//if double
    if (sum != UINT64_C(/*@SUM@*/)) {
        printf("another sum over all logged samples\n");
        wrong++;
    }
//end double
    printf("%s: %ld steps, %d of %d stored samples seen, %d numbers differ\n", wrong || row < ROWS ? "FAILED" : "ok",
        (long)k, row, ROWS, wrong);
//if double
    if (wrong) {
        printf("%s\n", TANDEMLIFT_WRONG_BITS);
    }
//end double
    return wrong || row < ROWS ? 1 : 0;
}
