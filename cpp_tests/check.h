/* Checks for test programs in C and C++: say where, and end the program. */
#ifndef HOLEFILL_TESTS_CHECK_H
#define HOLEFILL_TESTS_CHECK_H

#include <stdio.h>
#include <stdlib.h>

#define CHECK(condition)                                                                   \
    do {                                                                                   \
        if (!(condition)) {                                                                \
            fprintf(stderr, "%s:%d: does not hold: %s\n", __FILE__, __LINE__, #condition); \
            exit(1);                                                                       \
        }                                                                                  \
    } while (0)

/* Checks the status of a call. */
#define CHECK_STATUS(call, expected)                                                                    \
    do {                                                                                                \
        const HolefillStatus found_ = (call);                                                           \
        if (found_ != (expected)) {                                                                     \
            fprintf(stderr, "%s:%d: %s gives %s instead of %s\n", __FILE__, __LINE__, #call,            \
                    holefill_status_name(found_), holefill_status_name(expected));                      \
            exit(1);                                                                                    \
        }                                                                                               \
    } while (0)

#define CHECK_OK(call) CHECK_STATUS(call, HOLEFILL_STATUS_OK)

#endif
