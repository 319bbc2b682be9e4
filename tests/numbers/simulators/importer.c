/*
 * Simulates a functional mock-up unit as an importing tool does: importer GUID FIRST_INPUT INPUTS FIRST_OUTPUT OUTPUTS KIND TABLE
 * [PARAMETER VALUE]. KIND is "straight" or "held" inputs of co-simulation, or "exchange": the importer integrates. The table has
 * rows and step, then the inputs of each row. Prints the outputs of each row.
 */
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include "fmi2Functions.h"

enum { MOST = 64 };
static fmi2ValueReference reference[MOST];
static double u[2][MOST], y[MOST], slope[MOST];
static int inputs, first_input, outputs, first_output;

static void check(fmi2Status status, const char *what) {
    if (status == fmi2OK) return;
    fprintf(stderr, "%s: status %d\n", what, status);
    exit(1);
}

static void set(fmi2Component c, const double *values) {
    for (int i = 0; i < inputs; i++) reference[i] = first_input + i;
    check(fmi2SetReal(c, reference, inputs, values), "fmi2SetReal");
}

static void steepness(fmi2Component c, double h) {
    fmi2Integer order[MOST];
    for (int i = 0; i < inputs; i++) {
        order[i] = 1;
        slope[i] = (u[1][i] - u[0][i]) / h;
    }
    check(fmi2SetRealInputDerivatives(c, reference, inputs, order, slope), "fmi2SetRealInputDerivatives");
}

/* the importer's own steps: the classical Runge-Kutta scheme */
static void exchange(fmi2Component c, double t, double h, int states) {
    static const double nodes[4] = {0.0, 0.5, 0.5, 1.0}, weights[4] = {1.0, 2.0, 2.0, 1.0};
    double x0[MOST], x[MOST], k[MOST] = {0}, sum[MOST] = {0}, at[MOST];
    check(fmi2GetContinuousStates(c, x0, states), "fmi2GetContinuousStates");
    for (int stage = 0; stage < 4; stage++) {
        for (int i = 0; i < states; i++) x[i] = x0[i] + nodes[stage] * h * k[i];
        for (int i = 0; i < inputs; i++) at[i] = u[0][i] + nodes[stage] * (u[1][i] - u[0][i]);
        set(c, at);
        check(fmi2SetTime(c, t + nodes[stage] * h), "fmi2SetTime");
        check(fmi2SetContinuousStates(c, x, states), "fmi2SetContinuousStates");
        check(fmi2GetDerivatives(c, k, states), "fmi2GetDerivatives");
        for (int i = 0; i < states; i++) sum[i] += weights[stage] * k[i];
    }
    for (int i = 0; i < states; i++) x[i] = x0[i] + h / 6.0 * sum[i];
    check(fmi2SetTime(c, t + h), "fmi2SetTime");
    check(fmi2SetContinuousStates(c, x, states), "fmi2SetContinuousStates");
}

/* a step that is taken back and taken again leads to the same state */
static void again(fmi2Component c, double t, double h, int straight) {
    fmi2FMUstate before = NULL;
    double once[MOST], twice[MOST];
    int states = first_input / 2;
    set(c, u[0]);
    check(fmi2GetFMUstate(c, &before), "fmi2GetFMUstate");
    for (int turn = 0; turn < 2; turn++) {
        if (turn) check(fmi2SetFMUstate(c, before), "fmi2SetFMUstate");
        set(c, u[0]);
        if (straight) steepness(c, h);
        check(fmi2DoStep(c, t, h, fmi2True), "fmi2DoStep");
        check(fmi2GetContinuousStates(c, turn ? twice : once, states), "fmi2GetContinuousStates");
    }
    check(fmi2FreeFMUstate(c, &before), "fmi2FreeFMUstate");
    if (memcmp(once, twice, states * sizeof *once)) check(fmi2Error, "a step taken again");
}

int main(int count, char **argument) {
    if (count < 8) return 2;
    first_input = atoi(argument[2]), inputs = atoi(argument[3]), first_output = atoi(argument[4]), outputs = atoi(argument[5]);
    const char *kind = argument[6];
    FILE *table = fopen(argument[7], "r");
    int rows;
    double h;
    if (!table || fscanf(table, "%d %lf", &rows, &h) != 2) return 2;
    fmi2CallbackFunctions none = {0};
    if (fmi2Instantiate("other", fmi2CoSimulation, "{another}", "", &none, fmi2False, fmi2False)) return 3;
    fmi2Component c = fmi2Instantiate("one", fmi2CoSimulation, argument[1], "", &none, fmi2False, fmi2False);
    if (!c) return 4;
    check(fmi2SetupExperiment(c, fmi2False, 0.0, 0.0, fmi2False, 0.0), "fmi2SetupExperiment");
    check(fmi2EnterInitializationMode(c), "fmi2EnterInitializationMode");
    for (int i = 8; i + 1 < count; i += 2) {
        fmi2ValueReference parameter = atoi(argument[i]);
        double value = atof(argument[i + 1]);
        check(fmi2SetReal(c, &parameter, 1, &value), "a parameter");
    }
    for (int row = 0; row < rows; row++) {
        memcpy(u[0], u[1], sizeof u[0]);
        for (int i = 0; i < inputs; i++)
            if (fscanf(table, "%lf", &u[1][i]) != 1) return 2;
        if (row == 0) {
            set(c, u[1]);
            check(fmi2ExitInitializationMode(c), "fmi2ExitInitializationMode");
        } else if (!strcmp(kind, "exchange")) {
            exchange(c, (row - 1) * h, h, first_input / 2);
        } else {
            again(c, (row - 1) * h, h, !strcmp(kind, "straight"));
        }
        set(c, u[1]);
        for (int i = 0; i < outputs; i++) reference[i] = first_output + i;
        check(fmi2GetReal(c, reference, outputs, y), "fmi2GetReal");
        for (int i = 0; i < outputs; i++) printf("%.17g ", y[i]);
        printf("\n");
    }
    fmi2FreeInstance(c);
    return 0;
}
