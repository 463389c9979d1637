/* Samples of a pilot on a Cortex-M7: whether its thrusts are those stored, its instructions, and its stack. */
#include "mission_pilot.h"
#include "start.h"
#include "vectors.h"

#include <math.h>
#include <string.h>

#define CONTROL (*(volatile uint32_t *)0xE000E010) /* of the system timer, which counts down at 25 MHz */
#define RELOAD (*(volatile uint32_t *)0xE000E014)
#define VALUE (*(volatile uint32_t *)0xE000E018)
#define TICK 40 /* instructions: QEMU lets one pass in a nanosecond */
#define PAINTED 65536

static mission_PilotData pilot;
static mission_PilotInput input;
static number thrusts[MISSION_ROTORS];

/* What lies below the stack of the caller; inlined, so that it is not the stack of a function that has returned. */
static inline __attribute__((always_inline)) volatile char *below_stack(void)
{
    volatile char *pointer;
    __asm__ volatile("mov %0, sp" : "=r"(pointer));
    return pointer - PAINTED;
}

static inline __attribute__((always_inline)) void paint(volatile char *stack)
{
    for (int i = 0; i < PAINTED; i++) {
        stack[i] = (char)0xA5;
    }
}

static inline __attribute__((always_inline)) uint32_t used(const volatile char *stack)
{
    int i = 0;
    while (i < PAINTED && stack[i] == (char)0xA5) {
        i++;
    }
    return (uint32_t)(PAINTED - i);
}

static void line(const char *name, uint32_t value)
{
    print(name);
    print(" ");
    print_number(value);
    print("\n");
}

int main(void)
{
    uint32_t sum = 0, most = 0, stack = 0, wrong = 0;
    number farthest = 0;
    RELOAD = 0xFFFFFF;
    VALUE = 0;
    CONTROL = 5;
    mission_pilot_start(&pilot);
    for (int i = 0; i < VECTOR_COUNT; i++) {
        uint32_t ticks = 0;
        for (int again = 0; again < 40; again++) { /* 40 samples: a tick is then an instruction */
            memcpy(&pilot, VECTOR[i].memory, sizeof VECTOR[i].memory);
            pilot.samples = VECTOR[i].memory[0]; /* in single precision an integer */
            memcpy(&input, VECTOR[i].input, sizeof input);
            if (again == 0) {
                paint(below_stack());
            }
            const uint32_t before = VALUE;
            mission_pilot_step(&pilot, &input, thrusts);
            ticks += (before - VALUE) & 0xFFFFFF;
            if (again == 0) {
                const uint32_t here = used(below_stack());
                stack = here > stack ? here : stack;
            }
        }
        const uint32_t instructions = ticks * TICK / 40;
        sum += instructions;
        most = instructions > most ? instructions : most;
        for (int j = 0; j < MISSION_ROTORS; j++) {
            const number off = (number)fabs((double)(thrusts[j] - VECTOR[i].thrusts[j]));
            wrong += memcmp(&thrusts[j], &VECTOR[i].thrusts[j], sizeof(number)) != 0;
            farthest = off > farthest ? off : farthest;
        }
    }
    line("mean", sum / VECTOR_COUNT);
    line("most", most);
    line("stack", stack);
    line("wrong", wrong);
    line("farthest_uN", (uint32_t)(farthest * 1000000));
    return 0;
}
