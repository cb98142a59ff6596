/* A cantilever of finite elements with the contact at its tip, integrated by SUNDIALS ARKODE: a stiffly accurate ESDIRK of
 * order 5 with band matrices. Every opening and closing is located by repeating the step up to it, so that no state is
 * interpolated. The problem comes on standard input as numbers, in the order in which read_problem() and main() read them;
 * the results go to standard output, a key and its numbers on each line.
 *
 * States are deviations from the preload: displacement and velocity of each unknown of the elements in turn. The library
 * integrates their change since the start of the step; the state there is kept in extended precision, or the rounding of
 * displacements, times the stiffness of short elements, would limit the steps and show in the force. */
#include "band.h"

#include <arkode/arkode_arkstep.h>
#include <nvector/nvector_serial.h>

enum { NONE, SINE, LOG_SWEEP, HALF_SINE };
enum { MOST_EVENTS = 100000, MOST_TRIALS = 60 };

typedef struct {
    /* Beam: symmetric bands by rows, 2 band + 1 each. */
    int unknowns, band, tip;
    double *mass, *stiffness, *geometric, *load, *at_rest, mass_damping, stiffness_damping;
    /* Axial force (3 E I / L^3) y sin(3 y / (2 L)) from the deflection y, where it follows it; else the stiffness is 0. */
    double axial_stiffness, axial_length, deflection, axial_force;
    contact_law law;
    double preload_force, preload_indentation;
    int generator;
    double amplitude, frequency, phase, end_frequency, duration;
    /* Over the present communication step, from `since` on: input of acceleration and position of the fixed contact. */
    double since, acceleration, jerk, support, support_rate;
    int generates, closed;
    /* At the start of the step: the state, and what its stiffness and damping exert; room for displacements with the damping
     * of the stiffness. */
    long double *state;
    double *restoring, *damped;
} problem;

static const double TAU = 6.283185307179586476925;

static double generated(const problem *p, double t) {
    if (!p->generates) return 0.0;
    switch (p->generator) {
    case SINE:
        return p->amplitude * sin(TAU * p->frequency * t + p->phase);
    case LOG_SWEEP: {
        double octaves = log(p->end_frequency / p->frequency), cycles = p->frequency * p->duration / octaves;
        return p->amplitude * sin(TAU * cycles * expm1(octaves * t / p->duration) + p->phase);
    }
    case HALF_SINE:
        return p->amplitude * sin(0.5 * TAU * t / p->duration);
    default:
        return 0.0;
    }
}

static void indentation(const problem *p, double t, const double *y, double *d, double *rate) {
    const long double *tip = p->state + 2 * p->tip;
    long double moved = p->support + p->support_rate * (t - p->since) - tip[0];
    *d = (double)(p->preload_indentation + moved - y[2 * p->tip]);
    *rate = (double)(p->support_rate - tip[1] - y[2 * p->tip + 1]);
}

static double engaged(const problem *p, double t, const double *y) {
    double d, rate;
    indentation(p, t, y, &d, &rate);
    return engagement(&p->law, d, rate);
}

static double contact_force(const problem *p, double t, const double *y) {
    double d, rate;
    indentation(p, t, y, &d, &rate);
    return p->closed ? fmax(closed_branch(&p->law, d, rate).force, 0.0) : 0.0;
}

/* Axial force above that of the preload. */
static double axial_change(const problem *p, const double *y) {
    if (p->axial_stiffness == 0.0) return 0.0;
    double w = p->deflection + (double)p->state[2 * p->tip] + y[2 * p->tip];
    return p->axial_stiffness * w * sin(1.5 * w / p->axial_length) - p->axial_force;
}

/* Right-hand side of q' = v, M v' = f. */
static int right_hand_side(realtype t, N_Vector yv, N_Vector fv, void *data) {
    const problem *p = data;
    const double *y = N_VGetArrayPointer(yv);
    double *f = N_VGetArrayPointer(fv), d, rate;
    int n = p->unknowns, b = p->band;
    double acceleration = generated(p, t) + p->acceleration + p->jerk * (t - p->since), change = axial_change(p, y);
    for (int i = 0; i < n; i++) p->damped[i] = y[2 * i] + p->stiffness_damping * y[2 * i + 1];
    for (int i = 0; i < n; i++) {
        int row = i * (2 * b + 1) + b - i, from = i > b ? i - b : 0, to = i + b < n ? i + b : n - 1;
        const double *mass = p->mass + row, *stiffness = p->stiffness + row, *geometric = p->geometric + row;
        double sum = p->restoring[i] - p->load[i] * acceleration;
        for (int j = from; j <= to; j++) sum -= stiffness[j] * p->damped[j];
        for (int j = from; p->mass_damping != 0.0 && j <= to; j++) sum -= p->mass_damping * mass[j] * y[2 * j + 1];
        for (int j = from; change != 0.0 && j <= to; j++) {
            sum += change * geometric[j] * (p->at_rest[j] + (double)p->state[2 * j] + y[2 * j]);
        }
        f[2 * i] = (double)p->state[2 * i + 1] + y[2 * i + 1];
        f[2 * i + 1] = sum;
    }
    indentation(p, t, y, &d, &rate);
    f[2 * p->tip + 1] += (p->closed ? closed_branch(&p->law, d, rate).force : 0.0) - p->preload_force;
    return 0;
}

/* Without the slope of the axial force, which is small and not banded: Newton's method converges without it. */
static int jacobian(realtype t, N_Vector yv, N_Vector fv, SUNMatrix j, void *data, N_Vector w1, N_Vector w2, N_Vector w3) {
    (void)fv, (void)w1, (void)w2, (void)w3;
    const problem *p = data;
    const double *y = N_VGetArrayPointer(yv);
    int n = p->unknowns, b = p->band;
    double d, rate, change = axial_change(p, y);
    SUNMatZero(j);
    for (int i = 0; i < n; i++) {
        SM_ELEMENT_B(j, 2 * i, 2 * i + 1) = 1.0;
        for (int k = i > b ? i - b : 0; k < n && k <= i + b; k++) {
            int at = i * (2 * b + 1) + b + k - i;
            SM_ELEMENT_B(j, 2 * i + 1, 2 * k) = change * p->geometric[at] - p->stiffness[at];
            SM_ELEMENT_B(j, 2 * i + 1, 2 * k + 1) =
                -p->stiffness_damping * p->stiffness[at] - p->mass_damping * p->mass[at];
        }
    }
    if (p->closed) {
        indentation(p, t, y, &d, &rate);
        branch closed = closed_branch(&p->law, d, rate);
        SM_ELEMENT_B(j, 2 * p->tip + 1, 2 * p->tip) -= closed.stiffness;
        SM_ELEMENT_B(j, 2 * p->tip + 1, 2 * p->tip + 1) -= closed.damping;
    }
    return 0;
}

static int mass_matrix(realtype t, SUNMatrix m, void *data, N_Vector w1, N_Vector w2, N_Vector w3) {
    (void)t, (void)w1, (void)w2, (void)w3;
    const problem *p = data;
    int n = p->unknowns, b = p->band;
    SUNMatZero(m);
    for (int i = 0; i < n; i++) {
        SM_ELEMENT_B(m, 2 * i, 2 * i) = 1.0;
        for (int k = i > b ? i - b : 0; k < n && k <= i + b; k++) {
            SM_ELEMENT_B(m, 2 * i + 1, 2 * k + 1) = p->mass[i * (2 * b + 1) + b + k - i];
        }
    }
    return 0;
}

/* A symmetric band matrix, of which the diagonal and what stands right of it is read row by row. */
static double *read_band(int n, int b) {
    double *rows = array(n * (2 * b + 1));
    memset(rows, 0, sizeof(double) * (size_t)(n * (2 * b + 1)));
    for (int i = 0; i < n; i++) {
        for (int j = i; j < n && j <= i + b; j++) {
            rows[i * (2 * b + 1) + b + j - i] = rows[j * (2 * b + 1) + b + i - j] = number();
        }
    }
    return rows;
}

static double *read_vector(int n) {
    double *values = array(n);
    for (int i = 0; i < n; i++) values[i] = number();
    return values;
}

static problem read_problem(void) {
    problem p = {0};
    p.unknowns = (int)number(), p.band = (int)number(), p.tip = (int)number();
    p.mass = read_band(p.unknowns, p.band), p.stiffness = read_band(p.unknowns, p.band);
    p.geometric = read_band(p.unknowns, p.band);
    p.load = read_vector(p.unknowns), p.at_rest = read_vector(p.unknowns);
    p.mass_damping = number(), p.stiffness_damping = number();
    p.axial_stiffness = number(), p.axial_length = number(), p.deflection = number(), p.axial_force = number();
    p.law = read_law();
    p.preload_force = number(), p.preload_indentation = number();
    p.generator = (int)number(), p.amplitude = number(), p.frequency = number(), p.phase = number();
    p.end_frequency = number(), p.duration = number();
    p.closed = p.preload_force > 0.0;
    return p;
}

/* The integration: what has been reached and what it has cost. */
typedef struct {
    problem *p;
    void *arkode;
    N_Vector y; /* change since the start of the step */
    double t, size; /* of the next step */
    double *events, greatest;
    int event_count;
    /* Absolute tolerances of displacements and velocities at the force scale, which grow with the largest force so far. */
    double displacement, velocity, largest;
    N_Vector tolerances;
    long steps, failures, iterations;
} course;

/* The indentation goes with the force to the power 2/3. Slopes and curvatures, of which the stiffest follow the displacements
 * at once, are hardly asked. */
static void set_tolerances(course *c, double force) {
    double factor = pow(force, 2.0 / 3.0), *values = N_VGetArrayPointer(c->tolerances);
    for (int i = 0; i < 2 * c->p->unknowns; i++) {
        values[i] = factor * (i % 2 ? c->velocity : c->displacement) * (i / 2 % 3 == c->p->tip % 3 ? 1.0 : 1e3);
    }
    ARKStepSVtolerances(c->arkode, 0.0, c->tolerances);
    c->largest = force;
}

/* Ends the step: its change becomes part of the state. */
static void accept(course *c) {
    problem *p = c->p;
    if (c->greatest > 1.2 * c->largest) set_tolerances(c, c->greatest);
    double *y = N_VGetArrayPointer(c->y);
    int n = p->unknowns, b = p->band;
    for (int i = 0; i < 2 * n; i++) p->state[i] += y[i], y[i] = 0.0;
    for (int i = 0; i < n; i++) {
        long double sum = 0.0;
        for (int j = i > b ? i - b : 0; j < n && j <= i + b; j++) {
            int at = i * (2 * b + 1) + b + j - i;
            long double q = p->state[2 * j], v = p->state[2 * j + 1];
            sum -= p->stiffness[at] * (q + p->stiffness_damping * v) + p->mass_damping * p->mass[at] * v;
        }
        p->restoring[i] = (double)sum;
    }
}

/* A step from `start`, where the change is zero, towards `target` or to it. */
static int step(course *c, double start, double size, double target, int whole) {
    long steps, failures, iterations;
    N_VConst(0.0, c->y);
    ARKStepReInit(c->arkode, NULL, right_hand_side, start, c->y);
    ARKStepSetInitStep(c->arkode, size);
    ARKStepSetStopTime(c->arkode, target);
    int flag;
    do flag = ARKStepEvolve(c->arkode, target, c->y, &c->t, ARK_ONE_STEP);
    while (whole && flag >= 0 && c->t < target);
    ARKStepGetNumSteps(c->arkode, &steps), ARKStepGetNumErrTestFails(c->arkode, &failures);
    ARKStepGetNumNonlinSolvIters(c->arkode, &iterations);
    c->steps += steps, c->failures += failures, c->iterations += iterations;
    return flag;
}

/* Repeats the last step, from `start`, up to where the engagement is zero, between the start and `end` with another sign of
 * it: regula falsi with the Illinois weights. */
static int locate(course *c, double start, double end, double at_start, double at_end) {
    double low = start, high = end, at_low = at_start, at_high = at_end;
    int flag = 0, last = 0;
    for (int trial = 0; trial < MOST_TRIALS && flag >= 0 && high - low > 4e-16 * high; trial++) {
        double target = (low * at_high - high * at_low) / (at_high - at_low);
        if (!(target > low && target < high)) break;
        flag = step(c, start, target - start, target, 1);
        double found = engaged(c->p, c->t, N_VGetArrayPointer(c->y));
        if (found == 0.0) break;
        int upper = (found > 0.0) == (at_high > 0.0);
        if (upper) {
            high = target, at_high = found;
            if (last == 1) at_low *= 0.5;
        } else {
            low = target, at_low = found;
            if (last == -1) at_high *= 0.5;
        }
        last = upper ? 1 : -1;
    }
    return flag;
}

/* The part of a step at which an open contact is indented most, if the cubic through both ends shows an overlap. */
static double peak(double h, double d0, double r0, double d1, double r1) {
    if (!(r0 > 0.0 && r1 < 0.0)) return 0.0;
    double a = 3.0 * (h * (r0 + r1) - 2.0 * (d1 - d0)), b = 2.0 * (3.0 * (d1 - d0) - h * (2.0 * r0 + r1)), c = h * r0;
    double s = 2.0 * c / (-b + sqrt(fmax(b * b - 4.0 * a * c, 0.0)));
    return s > 0.0 && s < 1.0 && d0 + s * (c + s * (0.5 * b + s * a / 3.0)) > 0.0 ? s : 0.0;
}

static void change_branch(course *c) {
    if (c->event_count < MOST_EVENTS) c->events[c->event_count++] = c->t;
    c->p->closed = !c->p->closed;
    /* The force of a closing contact begins like the root of time, that of an opening one is smooth. */
    c->size *= c->p->closed ? 1e-5 : 1e-1;
}

/* From the present instant to `target`, between which inputs and generator are smooth. */
static int advance(course *c, double target) {
    problem *p = c->p;
    const double *y = N_VGetArrayPointer(c->y);
    int flag = 0;
    double e = engaged(p, c->t, y);
    /* A fixed contact that changes its velocity changes the force of a damped contact at once. */
    if (p->support_rate != 0.0 && (p->closed ? e < 0.0 : e > 0.0)) change_branch(c);
    while (c->t < target && c->event_count < MOST_EVENTS) {
        double start = c->t, next, d0, r0, d1, r1;
        indentation(p, start, y, &d0, &r0);
        if ((flag = step(c, start, c->size, target, 0)) < 0) return flag;
        ARKStepGetCurrentStep(c->arkode, &next);
        if (c->t < target || next > c->size) c->size = next;
        indentation(p, c->t, y, &d1, &r1);
        double end = c->t, after = engaged(p, end, y);
        double part = !p->closed && after <= 0.0 && p->law.kind == POWER ? peak(end - start, d0, r0, d1, r1) : 0.0;
        if (part > 0.0) {
            double top = start + part * (end - start);
            if ((flag = step(c, start, top - start, top, 1)) < 0) return flag;
            double found = engaged(p, top, y);
            if (found > 0.0) {
                end = top, after = found;
            } else if ((flag = step(c, start, end - start, end, 1)) < 0) {
                return flag;
            }
        }
        int changes = (after > 0.0) != p->closed;
        /* Where a branch has just begun, the sign at the start is that of rounding. */
        if (changes && (e > 0.0) == p->closed && (flag = locate(c, start, end, e, after)) < 0) return flag;
        c->greatest = fmax(c->greatest, contact_force(p, c->t, y));
        if (changes) change_branch(c);
        accept(c);
        e = engaged(p, c->t, y);
    }
    return flag;
}

int main(void) {
    problem p = read_problem();
    /* Amplitude and frequency of the inputs base.acceleration and support.displacement: linear between communication
     * points. */
    double shake = number(), shake_frequency = number(), travel = number(), travel_frequency = number();
    double size = number();
    int count = (int)number(), n = 2 * p.unknowns, half = 2 * p.band + 1;
    double scale = number(), displacement = number(), velocity = number(), budget = number(); /* N; m; m/s; s */

    SUNContext context;
    if (SUNContext_Create(NULL, &context)) return 2;
    course c = {0};
    c.p = &p, c.events = array(MOST_EVENTS);
    c.y = N_VNew_Serial(n, context);
    c.tolerances = N_VNew_Serial(n, context);
    c.displacement = displacement / pow(scale, 2.0 / 3.0), c.velocity = velocity / pow(scale, 2.0 / 3.0);
    N_VConst(0.0, c.y);
    p.state = calloc((size_t)n, sizeof(long double)), p.restoring = array(p.unknowns);
    p.damped = array(p.unknowns);
    if (!p.state) return 2;
    c.largest = INFINITY;
    accept(&c);
    c.arkode = ARKStepCreate(NULL, right_hand_side, 0.0, c.y, context);
    SUNMatrix system = SUNBandMatrix(n, half, half, context), mass = SUNBandMatrix(n, half, half, context);
    SUNLinearSolver linear = reduced_solver(p.unknowns, p.band, context);
    SUNLinearSolver mass_linear = reduced_solver(p.unknowns, p.band, context);
    mass->ops->matvec = mass_times, mass->ops->zero = system->ops->zero = clear;
    ARKStepSetErrHandlerFn(c.arkode, silent, NULL);
    ARKStepSetUserData(c.arkode, &p);
    set_tolerances(&c, scale);
    ARKStepSetTableNum(c.arkode, ARKODE_ESDIRK547L2SA2_7_4_5, ARKODE_ERK_NONE);
    ARKStepSetLinearSolver(c.arkode, linear, system);
    ARKStepSetJacFn(c.arkode, jacobian);
    ARKStepSetMassLinearSolver(c.arkode, mass_linear, mass, SUNFALSE);
    ARKStepSetMassFn(c.arkode, mass_matrix);
    ARKStepSetMaxNumSteps(c.arkode, -1);
    ARKStepSetMaxErrTestFails(c.arkode, 30);
    ARKStepSetMaxConvFails(c.arkode, 30);

    double *forces = array(count), *greatest = array(count), begun = seconds();
    int flag = 0;
    c.size = 1e-3 * size;
    for (int k = 0; k < count && flag >= 0; k++) {
        double start = k * size, end = (k + 1) * size;
        /* Where the generator ends. */
        double last = p.generator == LOG_SWEEP || p.generator == HALF_SINE ? p.duration : INFINITY;
        p.since = start;
        p.acceleration = shake * sin(TAU * shake_frequency * start);
        p.jerk = (shake * sin(TAU * shake_frequency * (start + size)) - p.acceleration) / size;
        p.support = travel * sin(TAU * travel_frequency * start);
        p.support_rate = (travel * sin(TAU * travel_frequency * (start + size)) - p.support) / size;
        p.generates = start < last;
        c.greatest = contact_force(&p, start, N_VGetArrayPointer(c.y));
        if (p.generates && last < end) {
            flag = advance(&c, last);
            p.generates = 0;
        }
        if (flag >= 0) flag = advance(&c, end);
        forces[k] = contact_force(&p, end, N_VGetArrayPointer(c.y)), greatest[k] = c.greatest;
        if (seconds() - begun > budget) flag = -100;
        if (c.event_count == MOST_EVENTS) flag = -101;
    }
    if (flag < 0) {
        printf("failure %.17g flag %d\n", c.t, flag);
        return 0;
    }
    printf("work %ld %ld %ld\nevents", c.steps, c.failures, c.iterations);
    for (int i = 0; i < c.event_count; i++) printf(" %.17g", c.events[i]);
    printf("\nforces");
    for (int k = 0; k < count; k++) printf(" %.17g", forces[k]);
    printf("\ngreatest");
    for (int k = 0; k < count; k++) printf(" %.17g", greatest[k]);
    printf("\n");
    return 0;
}
