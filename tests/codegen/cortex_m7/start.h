/* Output of a program on a Cortex-M7 under QEMU. */
#ifndef START_H
#define START_H

#include <stdint.h>

int main(void);
void print(const char *text);
void print_number(uint32_t number);

#endif
