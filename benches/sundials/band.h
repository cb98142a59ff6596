/* Linear algebra of q' = v, M v' = f for the libraries: with the system matrix [1, -g; Q, V] of band matrices in which q and
 * v alternate, v follows from the symmetric V + g Q of half the size, and q = r + g v. */
#ifndef BAND_H
#define BAND_H

#include "contact.h"

#include <string.h>
#include <sunlinsol/sunlinsol_band.h>
#include <sunmatrix/sunmatrix_band.h>

typedef struct {
    int unknowns, band;
    double gamma;
    double *by_displacement; /* Q by rows, 2 band + 1 each */
    double *factor;          /* of V + g Q = L D L': L below its diagonal and D on it, by rows, band + 1 each */
    double *right;
} reduced;

static SUNLinearSolver_Type direct(SUNLinearSolver solver) {
    (void)solver;
    return SUNLINEARSOLVER_DIRECT;
}

static int factorise(SUNLinearSolver solver, SUNMatrix a) {
    reduced *r = solver->content;
    int n = r->unknowns, b = r->band;
    double *q = r->by_displacement, *l = r->factor;
    double gamma = r->gamma = -SM_ELEMENT_B(a, 0, 1);
    for (int i = 0; i < n; i++) {
        for (int j = i > b ? i - b : 0; j < n && j <= i + b; j++) {
            q[i * (2 * b + 1) + b + j - i] = SM_ELEMENT_B(a, 2 * i + 1, 2 * j);
        }
        double *row = l + i * (b + 1) + b - i;
        for (int j = i > b ? i - b : 0; j <= i; j++) {
            const double *other = l + j * (b + 1) + b - j;
            double sum = SM_ELEMENT_B(a, 2 * i + 1, 2 * j + 1) + gamma * SM_ELEMENT_B(a, 2 * i + 1, 2 * j);
            for (int k = i > b ? i - b : 0; k < j && j < i; k++) sum -= row[k] * other[k];
            row[j] = sum;
        }
        for (int j = i > b ? i - b : 0; j < i; j++) {
            double product = row[j];
            row[j] /= l[j * (b + 1) + b];
            row[i] -= product * row[j];
        }
        if (row[i] == 0.0) return 1;
    }
    return 0;
}

static int substitute(SUNLinearSolver solver, SUNMatrix a, N_Vector xv, N_Vector bv, realtype tolerance) {
    (void)a, (void)tolerance;
    const reduced *r = solver->content;
    int n = r->unknowns, b = r->band;
    const double *right = N_VGetArrayPointer(bv);
    double *x = N_VGetArrayPointer(xv), *v = r->right;
    for (int i = 0; i < n; i++) {
        const double *q = r->by_displacement + i * (2 * b + 1) + b - i, *row = r->factor + i * (b + 1) + b - i;
        double sum = right[2 * i + 1];
        int from = i > b ? i - b : 0, to = i + b < n ? i + b : n - 1;
        for (int j = from; j <= to; j++) sum -= q[j] * right[2 * j];
        for (int j = from; j < i; j++) sum -= row[j] * v[j];
        v[i] = sum;
    }
    for (int i = n - 1; i >= 0; i--) {
        double sum = v[i] / r->factor[i * (b + 1) + b];
        int to = i + b < n ? i + b : n - 1;
        for (int j = i + 1; j <= to; j++) sum -= r->factor[j * (b + 1) + b + i - j] * v[j];
        v[i] = sum;
        x[2 * i] = right[2 * i] + r->gamma * sum;
        x[2 * i + 1] = sum;
    }
    return 0;
}

/* [1, 0; 0, M] times a vector. */
static int mass_times(SUNMatrix a, N_Vector xv, N_Vector yv) {
    const double *x = N_VGetArrayPointer(xv);
    double *y = N_VGetArrayPointer(yv);
    int n = (int)SM_COLUMNS_B(a) / 2, b = (int)SM_UBAND_B(a) / 2;
    for (int i = 0; i < n; i++) {
        double sum = 0.0;
        /* Symmetric: the column is the row. */
        const double *column = SM_COLUMN_B(a, 2 * i + 1);
        int from = i > b ? i - b : 0, to = i + b < n ? i + b : n - 1;
        for (int j = from; j <= to; j++) sum += column[2 * (j - i)] * x[2 * j + 1];
        y[2 * i] = x[2 * i];
        y[2 * i + 1] = sum;
    }
    return 0;
}

/* What the library does column by column. */
static int clear(SUNMatrix a) {
    memset(SM_DATA_B(a), 0, sizeof(double) * (size_t)SM_LDATA_B(a));
    return 0;
}

static SUNLinearSolver reduced_solver(int unknowns, int band, SUNContext context) {
    SUNLinearSolver solver = SUNLinSolNewEmpty(context);
    reduced *r = malloc(sizeof(reduced));
    if (!solver || !r) exit(2);
    r->unknowns = unknowns, r->band = band;
    r->by_displacement = array(unknowns * (2 * band + 1)), r->factor = array(unknowns * (band + 1));
    r->right = array(unknowns);
    solver->content = r;
    solver->ops->gettype = direct, solver->ops->setup = factorise, solver->ops->solve = substitute;
    return solver;
}

#endif
