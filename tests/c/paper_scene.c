/* The published 1 kHz run, scenes/paper-1khz.toml, in a library that is loaded as an importer loads it.
 *
 *     paper_scene LIBRARY
 *
 * Prints the contact force in N at every communication point, a line each, with all its digits. */

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

#include "relay_contact.h"

/* m/s2, Hz, s. */
static const fmi2Real AMPLITUDE = 98.0, FREQUENCY = 1000.0, STOP = 0.02, STEP = 1e-5;

static void end(const char *what, const char *why) {
    fprintf(stderr, "%s: %s\n", what, why);
    exit(1);
}

static void check(fmi2Status status, const char *call) {
    if (status != fmi2OK) {
        end(call, "not OK");
    }
}

/* Calls the function of the library by this name; for most of them the answer has to be OK. */
#define FUNCTION(name) __typeof__(name) *name##_; find(library, #name, &name##_)
#define CALL(name, ...) check(name##_(__VA_ARGS__), #name)

#ifdef _WIN32
typedef HMODULE Library;

static Library load(const char *path) {
    const Library library = LoadLibraryA(path);
    if (library == NULL) {
        fprintf(stderr, "error %lu\n", GetLastError());
        end(path, "not loaded");
    }
    return library;
}
#else
typedef void *Library;

/* All symbols at once, so that one which is missing shows here. */
static Library load(const char *path) {
    const Library library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        end(path, dlerror());
    }
    return library;
}
#endif

/* Copied as bytes, since C has no cast from an object's address to that of a function. */
static void find(Library library, const char *name, void *function) {
#ifdef _WIN32
    const FARPROC found = GetProcAddress(library, name);
#else
    void *const found = dlsym(library, name);
#endif
    if (found == NULL) {
        end(name, "not in the library");
    }
    memcpy(function, &found, sizeof found);
}

static void logger(fmi2ComponentEnvironment environment, fmi2String instance, fmi2Status status, fmi2String category,
                   fmi2String message, ...) {
    va_list arguments;
    (void)environment;
    (void)status;
    va_start(arguments, message);
    fprintf(stderr, "%s, %s: ", instance, category);
    vfprintf(stderr, message, arguments);
    fprintf(stderr, "\n");
    va_end(arguments);
}

static fmi2Real point(int n) {
    const fmi2Real time = n * STEP;
    return time < STOP ? time : STOP;
}

int main(int count, char **arguments) {
    static const fmi2ValueReference choices[] = {RELAY_CONTACT_EFFECTS_EXCITATION, RELAY_CONTACT_EFFECTS_AXIAL_FORCE},
                                    sine[] = {RELAY_CONTACT_EXCITATION_AMPLITUDE, RELAY_CONTACT_EXCITATION_FREQUENCY},
                                    force = RELAY_CONTACT_CONTACT_FORCE;
    const fmi2Integer kinds[] = {RELAY_CONTACT_EXCITATION_KIND_SINE, RELAY_CONTACT_AXIAL_FORCE_KIND_FROM_PRELOAD};
    const fmi2Real values[] = {AMPLITUDE, FREQUENCY};
    const fmi2CallbackFunctions callbacks = {logger, NULL, NULL, NULL, NULL};
    Library library;
    fmi2Component c;
    fmi2Real value;
    int n;

    if (count != 2) {
        end("usage", "paper_scene LIBRARY");
    }
    library = load(arguments[1]);
    FUNCTION(fmi2Instantiate);
    FUNCTION(fmi2SetupExperiment);
    FUNCTION(fmi2EnterInitializationMode);
    FUNCTION(fmi2ExitInitializationMode);
    FUNCTION(fmi2SetInteger);
    FUNCTION(fmi2SetReal);
    FUNCTION(fmi2GetReal);
    FUNCTION(fmi2DoStep);
    FUNCTION(fmi2Terminate);
    FUNCTION(fmi2FreeInstance);

    c = fmi2Instantiate_("paper", fmi2CoSimulation, RELAY_CONTACT_GUID, NULL, &callbacks, fmi2False, fmi2False);
    if (c == NULL) {
        end("fmi2Instantiate", "no instance");
    }
    CALL(fmi2SetupExperiment, c, fmi2False, 0.0, 0.0, fmi2True, STOP);
    CALL(fmi2SetInteger, c, choices, 2, kinds);
    CALL(fmi2SetReal, c, sine, 2, values);
    CALL(fmi2EnterInitializationMode, c);
    CALL(fmi2ExitInitializationMode, c);
    for (n = 0;; ++n) {
        CALL(fmi2GetReal, c, &force, 1, &value);
        printf("%.17g\n", value);
        if (point(n) >= STOP) {
            break;
        }
        CALL(fmi2DoStep, c, point(n), point(n + 1) - point(n), fmi2True);
    }
    CALL(fmi2Terminate, c);
    fmi2FreeInstance_(c);
    return 0;
}
