/* Start of a program on a Cortex-M7 under QEMU, with output by semihosting. */
#include "start.h"

#include <stddef.h>
#include <string.h>

extern char data_begin, data_end, data_load, bss_begin, bss_end, stack_top;

static void host(int operation, const void *argument)
{
    register int r0 __asm__("r0") = operation;
    register const void *r1 __asm__("r1") = argument;
    __asm__ volatile("bkpt 0xAB" : "+r"(r0) : "r"(r1) : "memory");
}

void print(const char *text)
{
    host(4, text);
}

void print_number(uint32_t number)
{
    char digits[12];
    int i = 11;
    digits[i] = 0;
    do {
        digits[--i] = (char)('0' + number % 10);
        number /= 10;
    } while (number);
    print(digits + i);
}

void reset(void);
void reset(void)
{
    *(volatile uint32_t *)0xE000ED88 |= UINT32_C(0xF) << 20; /* floating-point unit on */
    __asm__ volatile("dsb\n isb");
    memcpy(&data_begin, &data_load, (size_t)(&data_end - &data_begin));
    memset(&bss_begin, 0, (size_t)(&bss_end - &bss_begin));
    host(0x18, main() ? (const void *)0x20023 : (const void *)0x20026);
    for (;;) {
    }
}

struct vectors {
    void *stack;
    void (*start)(void);
};
__attribute__((section(".vectors"), used)) static const struct vectors VECTORS = {&stack_top, reset};
