/* The contact inside a C program's own loop: the program has the vibration and the circuit, the library the contact.
 * Linux, from the project's top folder, C99:
 *
 *     cargo xtask fmu
 *     cc -std=c99 -O2 -Idist/include examples/embed.c -Ldist/lib -lrelay_contact -lm -Wl,-rpath,'$ORIGIN/lib' -o dist/embed
 *     mkdir -p out
 *     dist/embed                                                     # 400 m/s2 over 20 ms, to out/embed-c.csv
 *     .venv/bin/python -m relay_contact plot out/embed-c.csv
 *
 * Vibration, circuit and numbers are those of embed.rs, where they are explained. The header names every variable
 * (RELAY_CONTACT_CONTACT_FORCE), and the functions are those of FMI 2.0 for co-simulation: what is set and read with
 * which, the header says. A call that fails has sent the reason to the logger before it returns. */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "relay_contact.h"

static const char usage[] = "A relay contact, shaken and under current, in a loop of one's own.\n"
                            "usage: embed [ACCELERATION [DURATION [FILE]]]\n"
                            "  ACCELERATION  greatest base acceleration, m/s2 (400)\n"
                            "  DURATION      simulated time, 2e-6 to 10 s (0.02, done in some 0.1 s)\n"
                            "  FILE          table to write, CSV in SI units (out/embed-c.csv)\n";

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

/* Source, V; load, Ohm and H; conductance of the quench, S; its capacitor, F. */
static const double SOURCE = 6.0, LOAD = 60.0, INDUCTANCE = 1e-3, QUENCH = 1.0 / 47.0, CAPACITANCE = 220e-9;

/* Current through the load, A; voltage of the capacitor, V; conductance of the contact, S; greatest voltage across the
 * contact and greatest current through it so far, V and A. */
typedef struct {
    double current, capacitor, conductance, greatest_voltage, greatest_current;
} Circuit;

static double voltage_of(const Circuit *circuit) {
    return (circuit->current + QUENCH * circuit->capacitor) / (circuit->conductance + QUENCH);
}

/* Advances by `size` seconds, to the end of which the contact has another conductance, by the trapezoidal rule. */
static void advance_circuit(Circuit *circuit, double conductance, double size) {
    const double half = 0.5 * size, voltage = voltage_of(circuit), share = 1.0 / (conductance + QUENCH);
    const double i = circuit->current + half * (2.0 * SOURCE - LOAD * circuit->current - voltage) / INDUCTANCE;
    const double u = circuit->capacitor + half * QUENCH * (voltage - circuit->capacitor) / CAPACITANCE;
    const double a = 1.0 + half * (LOAD + share) / INDUCTANCE, b = half * share * QUENCH / INDUCTANCE;
    const double d = 1.0 + half * QUENCH * (1.0 - share * QUENCH) / CAPACITANCE;
    const double c = -half * share * QUENCH / CAPACITANCE;
    const double determinant = a * d - b * c;
    circuit->current = (d * i - b * u) / determinant;
    circuit->capacitor = (a * u - c * i) / determinant;
    circuit->conductance = conductance;
    circuit->greatest_voltage = fmax(circuit->greatest_voltage, voltage_of(circuit));
    circuit->greatest_current = fmax(circuit->greatest_current, conductance * voltage_of(circuit));
}

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
    fprintf(stderr, "\r%s: %s: ", instance, category);
    va_start(arguments, message);
    vfprintf(stderr, message, arguments);
    va_end(arguments);
    fputc('\n', stderr);
}

/* A step of contact and circuit. The acceleration changes linearly over it. */
static fmi2Status advance(fmi2Component contact, Circuit *circuit, double amplitude, double time, double size) {
    const fmi2ValueReference acceleration = RELAY_CONTACT_BASE_ACCELERATION;
    const fmi2ValueReference conductance = RELAY_CONTACT_CONTACT_CONDUCTANCE;
    const fmi2Integer first = 1;
    const double now = vibration(amplitude, time), rate = (vibration(amplitude, time + size) - now) / size;
    double value;
    TRY(fmi2SetReal(contact, &acceleration, 1, &now));
    TRY(fmi2SetRealInputDerivatives(contact, &acceleration, 1, &first, &rate));
    TRY(fmi2DoStep(contact, time, size, fmi2False));
    TRY(fmi2GetReal(contact, &conductance, 1, &value));
    advance_circuit(circuit, value, size);
    return fmi2OK;
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

/* A row: time, base acceleration, contact force, contact resistance, contact voltage, load current. */
typedef double Row[6];

/* Runs `count` steps into the rows; `*saved` is the importer's to free. */
static fmi2Status run(fmi2Component contact, double amplitude, long count, Row *rows, fmi2FMUstate *saved) {
    static const fmi2ValueReference switches[] = {RELAY_CONTACT_CONTACT_LAST_OPENING,
                                                  RELAY_CONTACT_CONTACT_LAST_CLOSING};
    static const fmi2ValueReference outputs[] = {RELAY_CONTACT_CONTACT_FORCE, RELAY_CONTACT_CONTACT_RESISTANCE};
    const fmi2ValueReference conductance = RELAY_CONTACT_CONTACT_CONDUCTANCE;
    const fmi2ValueReference chatter = RELAY_CONTACT_CHATTER_COUNT;
    const fmi2ValueReference longest_interruption = RELAY_CONTACT_CHATTER_LONGEST_INTERRUPTION;
    Circuit circuit = {0};
    fmi2Integer interruptions;
    double longest, nanoseconds;
    long n, repeated = 0;
    clock_t begun;

    TRY(initialize(contact));
    TRY(fmi2GetReal(contact, &conductance, 1, &circuit.conductance));
    circuit.current = SOURCE / (LOAD + 1.0 / circuit.conductance);
    circuit.capacitor = circuit.current / circuit.conductance;

    begun = clock();
    for (n = 0; n < count; ++n) {
        const double time = (double)n * STEP;
        const Circuit circuit_before = circuit;
        double *row = rows[n], before[2], after[2];
        /* A copy of all that moves; the first call allocates it, the others use it again. */
        TRY(fmi2GetFMUstate(contact, saved));
        TRY(fmi2GetReal(contact, switches, 2, before));
        TRY(advance(contact, &circuit, amplitude, time, STEP));
        TRY(fmi2GetReal(contact, switches, 2, after));
        if (after[0] != before[0] || after[1] != before[1]) {
            const double part = 0.1 * STEP;
            int k;
            TRY(fmi2SetFMUstate(contact, *saved));
            circuit = circuit_before;
            for (k = 0; k < 10; ++k) {
                TRY(advance(contact, &circuit, amplitude, time + k * part, part));
            }
            ++repeated;
        }
        row[0] = (double)(n + 1) * STEP;
        row[1] = vibration(amplitude, row[0]);
        TRY(fmi2GetReal(contact, outputs, 2, row + 2));
        row[4] = voltage_of(&circuit);
        row[5] = circuit.current;
        if (n * 100 / count != (n + 1) * 100 / count) {
            fprintf(stderr, "\r%3ld%%", (n + 1) * 100 / count);
        }
    }
    nanoseconds = 1e9 * (double)(clock() - begun) / CLOCKS_PER_SEC / (double)count;
    fputs("\r    \r", stderr);

    TRY(fmi2GetInteger(contact, &chatter, 1, &interruptions));
    TRY(fmi2GetReal(contact, &longest_interruption, 1, &longest));
    printf("interruptions of 5 us or more: %d\n", interruptions);
    printf("longest interruption: %.3f us\n", 1e6 * longest);
    printf("steps done again: %ld\n", repeated);
    printf("greatest voltage and current of the contact: %.3f V, %.4f A\n", circuit.greatest_voltage,
           circuit.greatest_current);
    if (circuit.greatest_voltage >= 12.0 || circuit.greatest_current >= 0.4) {
        printf("beyond 12 V and 0.4 A the contact would arc: the results do not hold\n");
    }
    printf("%.0f ns of processor time per step\n", nanoseconds);
    return fmi2Terminate(contact);
}

/* Whether the table could be written. */
static int write_table(const char *path, Row *rows, long count) {
    FILE *file = fopen(path, "w");
    int written;
    long n;
    if (file == NULL) {
        return 0;
    }
    fputs("time,base.acceleration,contact.force,contact.resistance,contact.voltage,load.current [A]\n", file);
    for (n = 0; n < count; ++n) {
        const double *row = rows[n];
        fprintf(file, "%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n", row[0], row[1], row[2], row[3], row[4], row[5]);
    }
    written = !ferror(file);
    return fclose(file) == 0 && written;
}

/* An argument as a number, or the default where there is none. */
static double number(int argc, char **argv, int at, const char *name, double otherwise) {
    char *end;
    double value;
    if (at >= argc) {
        return otherwise;
    }
    value = strtod(argv[at], &end);
    if (end == argv[at] || *end != '\0') {
        fprintf(stderr, "%s = %s: expected a number\n%s", name, argv[at], usage);
        exit(2);
    }
    return value;
}

int main(int argc, char **argv) {
    const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    const char *path = argc > 3 ? argv[3] : "out/embed-c.csv";
    fmi2Component contact;
    fmi2FMUstate saved = NULL;
    fmi2Status status = fmi2Error;
    double amplitude, duration;
    long count;
    Row *rows;

    if (argc == 2 && strcmp(argv[1], "--help") == 0) {
        fputs(usage, stdout);
        return 0;
    }
    amplitude = number(argc, argv, 1, "ACCELERATION", 400.0);
    duration = number(argc, argv, 2, "DURATION", 0.02);
    if (!(duration >= STEP && duration <= 10.0)) {
        fprintf(stderr, "DURATION = %g s: allowed is 2e-6 to 10 s\n%s", duration, usage);
        return 2;
    }
    if (argc > 4) {
        fprintf(stderr, "%d arguments: allowed are three\n%s", argc - 1, usage);
        return 2;
    }

    count = lround(duration / STEP);
    rows = malloc((size_t)count * sizeof *rows);
    /* A library of other variables than those of the header refuses its GUID. */
    contact = fmi2Instantiate("contact", fmi2CoSimulation, RELAY_CONTACT_GUID, NULL, &callbacks, fmi2False, fmi2False);
    if (rows != NULL && contact != NULL) {
        status = run(contact, amplitude, count, rows, &saved);
        fmi2FreeFMUstate(contact, &saved);
    }
    fmi2FreeInstance(contact);
    if (status <= fmi2Warning && !write_table(path, rows, count)) {
        perror(path);
        status = fmi2Error;
    }
    free(rows);
    if (status > fmi2Warning) {
        fprintf(stderr, "stopped, no results\n");
        return 1;
    }
    printf("%s\n", path);
    return 0;
}
