/* The contact inside a C program's own loop: the program has the vibration, the library the contact.
 * Linux, from the project's top folder, C99:
 *
 *     cargo xtask fmu
 *     cc -std=c99 -O2 -Idist/include examples/embed.c -Ldist/lib -lrelay_contact -lm -Wl,-rpath,'$ORIGIN/lib' -o dist/embed
 *     mkdir -p out
 *     dist/embed                                                     # 400 m/s2 over 20 ms, to out/embed-c.csv
 *     .venv/bin/python -m relay_contact plot out/embed-c.csv
 *
 * Vibration and numbers are those of embed.rs, where they are explained. The header names every variable
 * (RELAY_CONTACT_CONTACT_FORCE), and the functions are those of FMI 2.0 for co-simulation: what is set and read with
 * which, the header says. A call that fails has sent the reason to the logger before it returns. */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>

#include "relay_contact.h"

/* Leaves the function that it stands in, with the status, where a call fails. */
#define TRY(call)                                                                                                      \
    do {                                                                                                               \
        const fmi2Status status = (call);                                                                              \
        if (status > fmi2Warning) {                                                                                    \
            return status;                                                                                             \
        }                                                                                                              \
    } while (0)

static const double TURN = 6.283185307179586;
static const double STEP = 2e-6; /* s */

/* Base acceleration, m/s2. */
static double vibration(double amplitude, double time) {
    return amplitude * sin(TURN * 950.0 * time) * sin(TURN * 50.0 * time);
}

/* Prints what the component has to say, which comes in printf's form. */
static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    va_list arguments;
    (void)environment;
    (void)status;
    fprintf(stderr, "%s: %s: ", instance, category);
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

/* A step, over which the acceleration changes linearly. */
static fmi2Status advance(fmi2Component contact, double amplitude, double time, double size) {
    const fmi2ValueReference acceleration = RELAY_CONTACT_BASE_ACCELERATION;
    const fmi2Integer first = 1;
    const double now = vibration(amplitude, time), rate = (vibration(amplitude, time + size) - now) / size;
    TRY(fmi2SetReal(contact, &acceleration, 1, &now));
    TRY(fmi2SetRealInputDerivatives(contact, &acceleration, 1, &first, &rate));
    return fmi2DoStep(contact, time, size, fmi2False);
}

/* Sets the parameters; the others keep the start values, those of the published specimen. */
static fmi2Status initialize(fmi2Component contact) {
    const fmi2ValueReference reals[] = {RELAY_CONTACT_CONTACT_OVERTRAVEL, RELAY_CONTACT_CHATTER_MINIMUM_DURATION};
    const fmi2ValueReference extremes = RELAY_CONTACT_EFFECTS_EXTREMES;
    const double values[] = {0.19e-3, 5e-6};
    const fmi2Boolean no = fmi2False; /* what is not read need not cost */
    TRY(fmi2SetReal(contact, reals, 2, values));
    TRY(fmi2SetBoolean(contact, &extremes, 1, &no));
    TRY(fmi2SetupExperiment(contact, fmi2False, 0.0, 0.0, fmi2False, 0.0));
    TRY(fmi2EnterInitializationMode(contact));
    return fmi2ExitInitializationMode(contact);
}

/* Runs to the end; `*saved` is the importer's to free. */
static fmi2Status run(fmi2Component contact, double amplitude, double duration, FILE *table, fmi2FMUstate *saved) {
    static const fmi2ValueReference switches[] = {RELAY_CONTACT_CONTACT_LAST_OPENING,
                                                  RELAY_CONTACT_CONTACT_LAST_CLOSING};
    static const fmi2ValueReference outputs[] = {RELAY_CONTACT_CONTACT_FORCE, RELAY_CONTACT_CONTACT_RESISTANCE};
    const fmi2ValueReference chatter = RELAY_CONTACT_CHATTER_COUNT;
    const fmi2ValueReference longest_interruption = RELAY_CONTACT_CHATTER_LONGEST_INTERRUPTION;
    fmi2Integer interruptions;
    double longest, n, before[2], after[2], values[2];
    int k, repeated = 0;

    TRY(initialize(contact));
    fputs("time,base.acceleration,contact.force,contact.resistance\n", table);
    for (n = 0.0; (n + 0.5) * STEP < duration; n += 1.0) {
        const double time = n * STEP, next = (n + 1.0) * STEP;
        /* A copy of all that moves; the first call allocates it, the others use it again. */
        TRY(fmi2GetFMUstate(contact, saved));
        TRY(fmi2GetReal(contact, switches, 2, before));
        TRY(advance(contact, amplitude, time, STEP));
        TRY(fmi2GetReal(contact, switches, 2, after));
        if (after[0] != before[0] || after[1] != before[1]) {
            TRY(fmi2SetFMUstate(contact, *saved));
            for (k = 0; k < 10; ++k) {
                TRY(advance(contact, amplitude, time + k * (0.1 * STEP), 0.1 * STEP));
            }
            ++repeated;
        }
        TRY(fmi2GetReal(contact, outputs, 2, values));
        fprintf(table, "%.17g,%.17g,%.17g,%.17g\n", next, vibration(amplitude, next), values[0], values[1]);
    }
    TRY(fmi2GetInteger(contact, &chatter, 1, &interruptions));
    TRY(fmi2GetReal(contact, &longest_interruption, 1, &longest));
    printf("interruptions of 5 us or more: %d\n", interruptions);
    printf("longest interruption: %.3f us\n", 1e6 * longest);
    printf("steps done again: %d\n", repeated);
    return fmi2Terminate(contact);
}

/* Whether a text is a number, which it gives. */
static int read_number(const char *text, double *value) {
    char *end;
    *value = strtod(text, &end);
    return end != text && *end == '\0';
}

int main(int argc, char **argv) {
    const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    double numbers[] = {400.0, 0.02}; /* m/s2, s */
    const char *path = argc > 3 ? argv[3] : "out/embed-c.csv";
    FILE *table;
    fmi2FMUstate saved = NULL;
    fmi2Status status = fmi2Error;
    fmi2Component contact;
    int k;

    for (k = 0; k < 2 && k + 1 < argc; ++k) {
        if (!read_number(argv[k + 1], &numbers[k])) {
            fprintf(stderr, "%s: not a number\n", argv[k + 1]);
            return 1;
        }
    }
    if (!isfinite(numbers[1]) || numbers[1] <= 0.0) {
        fprintf(stderr, "%g s: not allowed, allowed is a positive number\n", numbers[1]);
        return 1;
    }
    table = fopen(path, "w");
    /* A library of other variables than those of the header refuses its GUID. */
    contact = fmi2Instantiate("contact", fmi2CoSimulation, RELAY_CONTACT_GUID, NULL, &callbacks, fmi2False, fmi2False);
    if (table == NULL) {
        perror(path);
    } else if (contact != NULL) {
        status = run(contact, numbers[0], numbers[1], table, &saved);
        fmi2FreeFMUstate(contact, &saved);
    }
    fmi2FreeInstance(contact);
    if (table == NULL || fclose(table) != 0 || status > fmi2Warning) {
        fprintf(stderr, "stopped, no results\n");
        return 1;
    }
    printf("%s\n", path);
    return 0;
}
