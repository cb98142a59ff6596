/* A full life of two instances, from C, with the generated header and its constants. */

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <string.h>

#include "relay_contact.h"

static int failures = 0;
static int messages = 0;
static char last_message[1024];

#define CHECK(condition)                                                                                               \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "line %d: %s\n", __LINE__, #condition);                                                    \
            ++failures;                                                                                                \
        }                                                                                                              \
    } while (0)

/* Formats as printf does, as the standard asks of an importer. */
static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    va_list arguments;
    va_start(arguments, message);
    vsnprintf(last_message, sizeof last_message, message, arguments);
    va_end(arguments);
    CHECK(environment == last_message);
    CHECK(strcmp(instance, "one") == 0 || strcmp(instance, "two") == 0);
    CHECK(strcmp(category, status == fmi2Error ? "logStatusError" : "logStatusWarning") == 0);
    ++messages;
}

static const fmi2ValueReference acceleration = RELAY_CONTACT_BASE_ACCELERATION, force = RELAY_CONTACT_CONTACT_FORCE,
                                preload = RELAY_CONTACT_PRELOAD_FORCE, overtravel = RELAY_CONTACT_CONTACT_OVERTRAVEL,
                                excitation = RELAY_CONTACT_EFFECTS_EXCITATION, closed = RELAY_CONTACT_CONTACT_CLOSED,
                                steps = RELAY_CONTACT_SOLVER_STEPS;

static fmi2Real real(fmi2Component c, fmi2ValueReference reference) {
    fmi2Real value = NAN;
    CHECK(fmi2GetReal(c, &reference, 1, &value) == fmi2OK);
    return value;
}

static void initialize(fmi2Component c, fmi2Real s) {
    const fmi2Integer sine = RELAY_CONTACT_EXCITATION_KIND_SINE;
    CHECK(fmi2SetupExperiment(c, fmi2True, 1e-6, 0.0, fmi2True, 1e-3) == fmi2OK);
    CHECK(fmi2SetReal(c, &overtravel, 1, &s) == fmi2OK);
    CHECK(fmi2SetInteger(c, &excitation, 1, &sine) == fmi2OK);
    CHECK(fmi2EnterInitializationMode(c) == fmi2OK);
    CHECK(fmi2ExitInitializationMode(c) == fmi2OK);
}

/* Steps of 5, 10, 15, ... us up to 0.6 ms; the force at the end. */
static fmi2Real run(fmi2Component c) {
    fmi2Real time = 0.0;
    const fmi2Real push = 1.0;
    int n;
    CHECK(fabs(real(c, force) - real(c, preload)) <= 1e-12 * real(c, preload));
    for (n = 1; n <= 15; ++n) {
        const fmi2Real step = n * 5e-6;
        CHECK(fmi2SetReal(c, &acceleration, 1, &push) == fmi2OK);
        CHECK(fmi2DoStep(c, time, step, fmi2True) == fmi2OK);
        CHECK(isfinite(real(c, force)) && real(c, force) >= 0.0);
        time += step;
    }
    return real(c, force);
}

int main(void) {
    const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, last_message};
    fmi2Component one, two;
    fmi2Real first, second, last = 0.0;
    fmi2Boolean is_closed = fmi2False;
    fmi2Integer count = 0;
    fmi2ValueReference unknown = 4000000000u;

    CHECK(strcmp(fmi2GetVersion(), "2.0") == 0);
    CHECK(strcmp(fmi2GetTypesPlatform(), "default") == 0);
    CHECK(fmi2Instantiate("one", fmi2CoSimulation, "no guid", NULL, &callbacks, fmi2False, fmi2False) == NULL);
    CHECK(messages == 1 && strstr(last_message, "no guid") != NULL);

    one = fmi2Instantiate("one", fmi2CoSimulation, RELAY_CONTACT_GUID, "file:///tmp", &callbacks, fmi2False, fmi2True);
    two = fmi2Instantiate("two", fmi2CoSimulation, RELAY_CONTACT_GUID, NULL, &callbacks, fmi2False, fmi2False);
    if (one == NULL || two == NULL || one == two) {
        fprintf(stderr, "no instances: %s\n", last_message);
        return 1;
    }

    initialize(one, 2e-4);
    initialize(two, 3e-4);
    CHECK(real(two, preload) > real(one, preload));
    first = run(one);
    CHECK(first != real(one, preload));
    CHECK(fmi2GetBoolean(one, &closed, 1, &is_closed) == fmi2OK && is_closed == (first > 0.0 ? fmi2True : fmi2False));
    CHECK(fmi2GetInteger(one, &steps, 1, &count) == fmi2OK && count > 0);
    CHECK(messages == 1);

    /* Wrong calls: after a step out of time only reading and reset are left. */
    CHECK(fmi2DoStep(one, 0.5, 1e-6, fmi2True) == fmi2Error);
    CHECK(messages == 2 && strstr(last_message, "currentCommunicationPoint = 0.5") != NULL);
    CHECK(fmi2GetRealStatus(one, fmi2LastSuccessfulTime, &last) == fmi2OK && fabs(last - 6e-4) < 1e-15);
    CHECK(fmi2DoStep(one, 6e-4, 1e-6, fmi2True) == fmi2Error);
    CHECK(fmi2Terminate(one) == fmi2Error);
    CHECK(real(one, force) == first);

    /* The second run of the same instance, and that of another with the same parameters, give the same bits. */
    CHECK(fmi2Reset(one) == fmi2OK);
    initialize(one, 2e-4);
    second = run(one);
    CHECK(memcmp(&first, &second, sizeof first) == 0);
    CHECK(fmi2Terminate(one) == fmi2OK);
    CHECK(fmi2DoStep(one, 6e-4, 1e-6, fmi2True) == fmi2Error);
    fmi2FreeInstance(one);

    CHECK(run(two) != first);
    CHECK(fmi2GetReal(two, &unknown, 1, &second) == fmi2Error);
    CHECK(strstr(last_message, "4000000000") != NULL);
    CHECK(fmi2Reset(two) == fmi2OK);
    initialize(two, 2e-4);
    second = run(two);
    CHECK(memcmp(&first, &second, sizeof first) == 0);
    fmi2FreeInstance(two);
    fmi2FreeInstance(NULL);

    if (failures == 0) {
        printf("life cycle passed, contact force %.17g N\n", first);
    }
    return failures == 0 ? 0 : 1;
}
