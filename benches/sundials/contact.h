/* Shared by the C programs: numbers from standard input, the contact law, processor time. */
#ifndef CONTACT_H
#define CONTACT_H

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

enum { POWER, LINEARISED, BONDED };

typedef struct {
    int kind;
    double stiffness, damping, offset; /* power: factor, beta_c, exponent; linear: k_j0, beta_c, indentation without force */
} contact_law;

typedef struct {
    double force, stiffness, damping;
} branch;

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1) {
        fprintf(stderr, "a number is missing on standard input\n");
        exit(2);
    }
    return value;
}

static double *array(int count) {
    double *values = malloc(sizeof(double) * (size_t)count);
    if (!values) exit(2);
    return values;
}

static contact_law read_law(void) {
    contact_law law;
    law.kind = (int)number(), law.stiffness = number(), law.damping = number(), law.offset = number();
    return law;
}

/* The closed branch, continued past the release so that a step may run over it before the root is found. */
static branch closed_branch(const contact_law *law, double d, double rate) {
    branch b = {0.0, 0.0, 0.0};
    if (law->kind != POWER) {
        b.force = law->stiffness * (d - law->offset + law->damping * rate);
        b.stiffness = law->stiffness;
        b.damping = law->stiffness * law->damping;
    } else if (d > 0.0) {
        double p = law->offset;
        double slope = law->stiffness * (p == 1.5 ? sqrt(d) : pow(d, p - 1.0)), g = d + p * law->damping * rate;
        b.force = slope * g;
        b.stiffness = slope * (1.0 + (p - 1.0) * g / d);
        b.damping = p * law->damping * slope;
    }
    return b;
}

/* Positive while the contact is closed. */
static double engagement(const contact_law *law, double d, double rate) {
    if (law->kind == POWER) return fmin(d, d + law->offset * law->damping * rate);
    return d - law->offset + law->damping * rate;
}

/* Processor time of this thread. */
static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Error messages of the libraries: none, as what failed is printed at the end. */
static void silent(int code, const char *module, const char *function, char *message, void *data) {
    (void)code, (void)module, (void)function, (void)message, (void)data;
}

#endif
