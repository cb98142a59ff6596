/* The contact's modal equations integrated by SUNDIALS CVODE: BDF, dense analytic Jacobian, root finding, and a restart at
 * every opening and closing. The problem comes on standard input as numbers, in the order in which main() reads them; the
 * results go to standard output, a key and its numbers on each line. States are deviations from the preload. */
#include <cvode/cvode.h>
#include <math.h>
#include <nvector/nvector_serial.h>
#include <stdio.h>
#include <stdlib.h>
#include <sundials/sundials_version.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <time.h>

enum { MOST_EVENTS = 10000, OUT_OF_TIME = -100, TOO_MANY_EVENTS = -101 }; /* the last two beside the flags of CVODE */

typedef struct {
    int modes, closed;
    double factor, contact_damping, power; /* F = factor d^power (1 + power contact_damping d' / d) */
    double *omega_squared, *damping, *tip, *participation;
    double preload_force, preload_indentation, amplitude, angular_frequency, phase, support_rate;
} problem;

typedef struct {
    double force, stiffness, damping;
} branch;

static double number(void) {
    double value;
    if (scanf("%lf", &value) != 1) exit(2);
    return value;
}

static double *array(int count) {
    double *values = malloc(sizeof(double) * (size_t)count);
    if (!values) exit(2);
    return values;
}

/* The closed branch, continued past the release so that a step may run over it before the root is found. */
static branch closed_branch(const problem *p, double d, double rate) {
    branch b = {0.0, 0.0, 0.0};
    if (d <= 0.0) return b;
    double slope = p->factor * (p->power == 1.5 ? sqrt(d) : pow(d, p->power - 1.0));
    double g = d + p->power * p->contact_damping * rate;
    b.force = slope * g;
    b.stiffness = slope * (1.0 + (p->power - 1.0) * g / d);
    b.damping = p->power * p->contact_damping * slope;
    return b;
}

/* Processor time of this thread. */
static double seconds(void) {
    struct timespec now;
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
}

/* Error messages of the library: none, as what failed is printed at the end. */
static void silent(int code, const char *module, const char *function, char *message, void *data) {
    (void)code, (void)module, (void)function, (void)message, (void)data;
}

static void indentation(const problem *p, double t, const double *y, double *d, double *rate) {
    double e = p->support_rate * t, e_rate = p->support_rate;
    for (int i = 0; i < p->modes; i++) {
        e -= p->tip[i] * y[i];
        e_rate -= p->tip[i] * y[p->modes + i];
    }
    *d = p->preload_indentation + e;
    *rate = e_rate;
}

static int right_hand_side(realtype t, N_Vector yv, N_Vector dyv, void *data) {
    const problem *p = data;
    const double *y = N_VGetArrayPointer(yv);
    double *dy = N_VGetArrayPointer(dyv), d, rate;
    indentation(p, t, y, &d, &rate);
    double force = (p->closed ? closed_branch(p, d, rate).force : 0.0) - p->preload_force;
    double acceleration = p->amplitude * sin(p->angular_frequency * t + p->phase);
    for (int i = 0; i < p->modes; i++) {
        double q = y[i], v = y[p->modes + i];
        dy[i] = v;
        dy[p->modes + i] =
            p->tip[i] * force - p->participation[i] * acceleration - p->damping[i] * v - p->omega_squared[i] * q;
    }
    return 0;
}

static int jacobian(realtype t, N_Vector yv, N_Vector dyv, SUNMatrix j, void *data, N_Vector w1, N_Vector w2, N_Vector w3) {
    (void)dyv, (void)w1, (void)w2, (void)w3;
    const problem *p = data;
    int n = p->modes;
    double d, rate;
    indentation(p, t, N_VGetArrayPointer(yv), &d, &rate);
    branch b = {0.0, 0.0, 0.0};
    if (p->closed) b = closed_branch(p, d, rate);
    SUNMatZero(j);
    for (int column = 0; column < n; column++) {
        double *by_q = SUNDenseMatrix_Column(j, column), *by_v = SUNDenseMatrix_Column(j, n + column);
        for (int row = 0; row < n; row++) {
            by_q[n + row] = -p->tip[row] * b.stiffness * p->tip[column];
            by_v[n + row] = -p->tip[row] * b.damping * p->tip[column];
        }
        by_q[n + column] -= p->omega_squared[column];
        by_v[n + column] -= p->damping[column];
        by_v[column] = 1.0;
    }
    return 0;
}

static int roots(realtype t, N_Vector yv, realtype *g, void *data) {
    const problem *p = data;
    double d, rate;
    indentation(p, t, N_VGetArrayPointer(yv), &d, &rate);
    g[0] = fmin(d, d + p->power * p->contact_damping * rate);
    return 0;
}

typedef struct {
    double relative, *absolute, end;
    int cells;
    double budget; /* s of processor time */
} task;

typedef struct {
    double *forces, *events, reached, time;
    int event_count, flag;
} result;

/* Sets up the library and integrates, from the state of rest to the last force. */
static void integrate(problem *p, const task *of, result *r) {
    double start = seconds();
    int n = p->modes;
    p->closed = p->preload_force > 0.0;
    SUNContext context;
    if (SUNContext_Create(NULL, &context)) exit(2);
    N_Vector y = N_VNew_Serial(2 * n, context), tolerances = N_VMake_Serial(2 * n, of->absolute, context);
    N_VConst(0.0, y);
    void *cvode = CVodeCreate(CV_BDF, context);
    SUNMatrix matrix = SUNDenseMatrix(2 * n, 2 * n, context);
    SUNLinearSolver linear = SUNLinSol_Dense(y, matrix, context);
    CVodeInit(cvode, right_hand_side, 0.0, y);
    CVodeSetErrHandlerFn(cvode, silent, NULL);
    CVodeSVtolerances(cvode, of->relative, tolerances);
    CVodeSetUserData(cvode, p);
    CVodeSetMaxNumSteps(cvode, 500000);
    CVodeSetLinearSolver(cvode, linear, matrix);
    CVodeSetJacFn(cvode, jacobian);
    CVodeRootInit(cvode, 1, roots);
    CVodeSetNoInactiveRootWarn(cvode);

    int direction = p->closed ? -1 : 1;
    double d, rate, t = 0.0;
    CVodeSetRootDirection(cvode, &direction);
    r->event_count = 0;
    r->flag = CV_SUCCESS;
    r->forces[0] = p->preload_force;
    for (int cell = 1; cell <= of->cells; cell++) {
        double target = of->end * cell / of->cells;
        while ((r->flag = CVode(cvode, target, y, &t, CV_NORMAL)) == CV_ROOT_RETURN && r->event_count < MOST_EVENTS) {
            r->events[r->event_count++] = t;
            p->closed = !p->closed;
            direction = p->closed ? -1 : 1;
            CVodeReInit(cvode, t, y);
            CVodeSetRootDirection(cvode, &direction);
            if (target - t < 1e-12 * of->end) break; /* too close for a step */
        }
        if (r->event_count == MOST_EVENTS) r->flag = TOO_MANY_EVENTS;
        if (seconds() - start > of->budget) r->flag = OUT_OF_TIME;
        if (r->flag < 0) break;
        indentation(p, t, N_VGetArrayPointer(y), &d, &rate);
        r->forces[cell] = p->closed ? fmax(closed_branch(p, d, rate).force, 0.0) : 0.0;
    }
    r->reached = t;
    r->time = seconds() - start;
    CVodeFree(&cvode);
    SUNLinSolFree(linear);
    SUNMatDestroy(matrix);
    N_VDestroy(y);
    N_VDestroy(tolerances);
    SUNContext_Free(&context);
}

int main(void) {
    problem p;
    p.modes = (int)number();
    int n = p.modes;
    p.omega_squared = array(n), p.damping = array(n), p.tip = array(n), p.participation = array(n);
    for (int i = 0; i < n; i++) {
        p.omega_squared[i] = number(), p.damping[i] = number(), p.tip[i] = number(), p.participation[i] = number();
    }
    p.factor = number(), p.contact_damping = number(), p.power = number();
    p.preload_force = number(), p.preload_indentation = number();
    p.amplitude = number(), p.angular_frequency = number(), p.phase = number(), p.support_rate = number();
    task of = {.relative = number(), .absolute = array(2 * n)};
    for (int i = 0; i < 2 * n; i++) of.absolute[i] = number();
    of.end = number(), of.cells = (int)number(), of.budget = number();
    double short_run = number(); /* s; shorter ones are repeated, as the first of a process is slower */

    result r = {.forces = array(of.cells + 1), .events = array(MOST_EVENTS)};
    double spent = 0.0;
    while (spent < short_run) {
        integrate(&p, &of, &r);
        spent += r.time;
    }
    printf("version %s\n", SUNDIALS_VERSION);
    if (r.flag < 0) {
        const char *cause = r.flag == OUT_OF_TIME       ? "out of its time budget"
                            : r.flag == TOO_MANY_EVENTS ? "openings and closings without end"
                                                        : CVodeGetReturnFlagName(r.flag);
        printf("failure %.17g %s\n", r.reached, cause);
        return 0;
    }
    printf("time %.9g\n", r.time);
    printf("events");
    for (int i = 0; i < r.event_count; i++) printf(" %.17g", r.events[i]);
    printf("\nforces");
    for (int i = 0; i <= of.cells; i++) printf(" %.17g", r.forces[i]);
    printf("\n");
    return 0;
}
