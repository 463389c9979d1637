/* The pilot of the mission "/*@NAME@*/" beside stored samples: memory and input of a sample in, thrusts out. */
#include "mission_pilot.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#define VECTORS /*@VECTORS@*/

/* For each sample: the number of samples before it and the memory, the input, the thrusts that must come. */
static const struct {
    real memory[/*@MEMORY@*/];
    real input[/*@INPUT@*/];
    real thrusts[MISSION_ROTORS];
} VECTOR[VECTORS] = {
/*@DATA@*/
};

int main(void)
{
    static mission_PilotData pilot;
    int wrong = 0;
    mission_pilot_start(&pilot);
    for (int i = 0; i < VECTORS; i++) {
        mission_PilotInput input;
        real thrusts[MISSION_ROTORS];
        memcpy(&pilot, VECTOR[i].memory, sizeof VECTOR[i].memory);
//if single
        pilot.samples = (uint32_t)VECTOR[i].memory[0];
//end single
        memcpy(&input, VECTOR[i].input, sizeof input);
        mission_pilot_step(&pilot, &input, thrusts);
        for (int j = 0; j < MISSION_ROTORS; j++) {
            const real wanted = VECTOR[i].thrusts[j];
//if double
            const int differs = memcmp(&thrusts[j], &wanted, sizeof wanted) != 0;
//end double
//if single
            const int differs = !(fabsf(thrusts[j] - wanted) <= /*@TOLERANCE@*/);
//end single
            if (differs) {
                printf("sample %d, rotor %d: %.17g N, not %.17g N\n", i, j, (double)thrusts[j], (double)wanted);
                wrong++;
            }
        }
    }
    printf("%s: %d samples, %d thrusts differ\n", wrong ? "FAILED" : "ok", VECTORS, wrong);
//if double
    if (wrong) {
        printf("%s\n", TANDEMLIFT_WRONG_BITS);
    }
//end double
    return wrong ? 1 : 0;
}
