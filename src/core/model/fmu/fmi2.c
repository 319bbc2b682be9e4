/*
 * A model of Trimtab behind the functions of FMI 2.0, for model exchange and co-simulation.
 *
 * The headers of the standard (fmi2Functions.h and those that it includes) come with the importing tool. To link several of these
 * statically, define FMI2_FUNCTION_PREFIX as the model identifier with an underscore behind it.
 */
#include <stdlib.h>
#include <string.h>

#include "fmi2Functions.h"
#include "model.h"

/* value references: states, their derivatives, inputs, outputs, parameters */
enum {
    FIRST_DERIVATIVE = MODEL_STATES,
    FIRST_INPUT = 2 * MODEL_STATES,
    FIRST_OUTPUT = FIRST_INPUT + MODEL_INPUTS,
    FIRST_PARAMETER = FIRST_OUTPUT + MODEL_OUTPUTS,
    REFERENCES = FIRST_PARAMETER + MODEL_PARAMETERS
};

/* all that changes; one element more, since no array of C is empty */
typedef struct {
    double t, x[MODEL_STATES + 1], u[MODEL_INPUTS + 1], slope[MODEL_INPUTS + 1], p[MODEL_PARAMETERS + 1];
    int initialised;
} Values;

typedef struct {
    Values now;
    fmi2CallbackLogger logger;
    fmi2ComponentEnvironment environment;
    char name[256];
} Instance;

static void begin(Values *now) {
    static const double inputs[] = MODEL_INPUT_STARTS, parameters[] = MODEL_PARAMETER_STARTS;
    memset(now, 0, sizeof *now);
    memcpy(now->u, inputs, sizeof now->u);
    memcpy(now->p, parameters, sizeof now->p);
    model_initial(now->p, now->x, now->u, 0.0, now->x);
}

static fmi2Status fault(Instance *instance, fmi2Status status, const char *message) {
    if (instance->logger)
        instance->logger(instance->environment, instance->name, status, "logStatusError", "%s", message);
    return status;
}

const char *fmi2GetTypesPlatform(void) { return "default"; }

const char *fmi2GetVersion(void) { return "2.0"; }

fmi2Status fmi2SetDebugLogging(fmi2Component c, fmi2Boolean on, size_t count, const fmi2String categories[]) {
    (void)c; (void)on; (void)count; (void)categories;
    return fmi2OK;
}

fmi2Component fmi2Instantiate(fmi2String name, fmi2Type type, fmi2String guid, fmi2String location,
                              const fmi2CallbackFunctions *functions, fmi2Boolean visible, fmi2Boolean logging) {
    Instance *instance;
    (void)type; (void)location; (void)visible; (void)logging;
    instance = calloc(1, sizeof *instance);
    if (!instance) return NULL;
    if (functions) {
        instance->logger = functions->logger;
        instance->environment = functions->componentEnvironment;
    }
    strncpy(instance->name, name ? name : "", sizeof instance->name - 1);
    if (!guid || strcmp(guid, MODEL_GUID) != 0) {
        fault(instance, fmi2Error, "the GUID of modelDescription.xml is not that of the sources");
        free(instance);
        return NULL;
    }
    begin(&instance->now);
    return instance;
}

void fmi2FreeInstance(fmi2Component c) { free(c); }

fmi2Status fmi2SetupExperiment(fmi2Component c, fmi2Boolean known, fmi2Real tolerance, fmi2Real start, fmi2Boolean ends,
                               fmi2Real end) {
    (void)known; (void)tolerance; (void)ends; (void)end;
    ((Instance *)c)->now.t = start;
    return fmi2OK;
}

fmi2Status fmi2EnterInitializationMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2ExitInitializationMode(fmi2Component c) {
    ((Instance *)c)->now.initialised = 1;
    return fmi2OK;
}

fmi2Status fmi2Terminate(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2Reset(fmi2Component c) {
    begin(&((Instance *)c)->now);
    return fmi2OK;
}

fmi2Status fmi2GetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, fmi2Real value[]) {
    Instance *instance = c;
    Values *now = &instance->now;
    double dx[MODEL_STATES + 1], y[MODEL_OUTPUTS + 1];
    int rates = 0, outputs = 0;
    for (size_t i = 0; i < count; i++) {
        /* signed: there may be none of a kind */
        long long at = vr[i];
        if (at < FIRST_DERIVATIVE) {
            value[i] = now->x[at];
        } else if (at < FIRST_INPUT) {
            if (!rates) model_derivative(now->p, now->x, now->u, now->t, dx);
            rates = 1;
            value[i] = dx[at - FIRST_DERIVATIVE];
        } else if (at < FIRST_OUTPUT) {
            value[i] = now->u[at - FIRST_INPUT];
        } else if (at < FIRST_PARAMETER) {
            if (!outputs) model_output(now->p, now->x, now->u, now->t, y);
            outputs = 1;
            value[i] = y[at - FIRST_OUTPUT];
        } else if (at < REFERENCES) {
            value[i] = now->p[at - FIRST_PARAMETER];
        } else {
            return fault(instance, fmi2Error, "fmi2GetReal: there is no such variable");
        }
    }
    return fmi2OK;
}

fmi2Status fmi2SetReal(fmi2Component c, const fmi2ValueReference vr[], size_t count, const fmi2Real value[]) {
    Instance *instance = c;
    Values *now = &instance->now;
    int changed = 0;
    for (size_t i = 0; i < count; i++) {
        /* signed: there may be none of a kind */
        long long at = vr[i];
        if (at >= FIRST_INPUT && at < FIRST_OUTPUT) {
            now->u[at - FIRST_INPUT] = value[i];
        } else if (at >= FIRST_PARAMETER && at < REFERENCES) {
            now->p[at - FIRST_PARAMETER] = value[i];
            changed = 1;
        } else if (at < FIRST_DERIVATIVE) {
            now->x[at] = value[i];
        } else {
            return fault(instance, fmi2Error, "fmi2SetReal: inputs, parameters and states can be set");
        }
    }
    /* the initial state is a function of the parameters */
    if (changed && !now->initialised) model_initial(now->p, now->x, now->u, now->t, now->x);
    return fmi2OK;
}

/* there are no variables of other types */
#define NO_VARIABLES(function, type) \
    fmi2Status function(fmi2Component c, const fmi2ValueReference vr[], size_t count, type value[]) { \
        (void)vr; (void)value; \
        return count ? fault(c, fmi2Error, #function ": all variables are Real") : fmi2OK; \
    }
NO_VARIABLES(fmi2GetInteger, fmi2Integer)
NO_VARIABLES(fmi2GetBoolean, fmi2Boolean)
NO_VARIABLES(fmi2GetString, fmi2String)
NO_VARIABLES(fmi2SetInteger, const fmi2Integer)
NO_VARIABLES(fmi2SetBoolean, const fmi2Boolean)
NO_VARIABLES(fmi2SetString, const fmi2String)

fmi2Status fmi2GetFMUstate(fmi2Component c, fmi2FMUstate *state) {
    if (!*state) *state = malloc(sizeof(Values));
    if (!*state) return fault(c, fmi2Error, "fmi2GetFMUstate: no memory");
    memcpy(*state, &((Instance *)c)->now, sizeof(Values));
    return fmi2OK;
}

fmi2Status fmi2SetFMUstate(fmi2Component c, fmi2FMUstate state) {
    memcpy(&((Instance *)c)->now, state, sizeof(Values));
    return fmi2OK;
}

fmi2Status fmi2FreeFMUstate(fmi2Component c, fmi2FMUstate *state) {
    (void)c;
    free(*state);
    *state = NULL;
    return fmi2OK;
}

fmi2Status fmi2SerializedFMUstateSize(fmi2Component c, fmi2FMUstate state, size_t *size) {
    (void)state; (void)size;
    return fault(c, fmi2Error, "states are not serialised");
}

fmi2Status fmi2SerializeFMUstate(fmi2Component c, fmi2FMUstate state, fmi2Byte bytes[], size_t size) {
    (void)state; (void)bytes; (void)size;
    return fault(c, fmi2Error, "states are not serialised");
}

fmi2Status fmi2DeSerializeFMUstate(fmi2Component c, const fmi2Byte bytes[], size_t size, fmi2FMUstate *state) {
    (void)bytes; (void)size; (void)state;
    return fault(c, fmi2Error, "states are not serialised");
}

fmi2Status fmi2GetDirectionalDerivative(fmi2Component c, const fmi2ValueReference unknown[], size_t unknowns,
                                        const fmi2ValueReference known[], size_t knowns, const fmi2Real dknown[],
                                        fmi2Real dunknown[]) {
    (void)unknown; (void)unknowns; (void)known; (void)knowns; (void)dknown; (void)dunknown;
    return fault(c, fmi2Error, "directional derivatives are not provided");
}

/* model exchange */

fmi2Status fmi2EnterEventMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2NewDiscreteStates(fmi2Component c, fmi2EventInfo *info) {
    (void)c;
    memset(info, 0, sizeof *info);
    return fmi2OK;
}

fmi2Status fmi2EnterContinuousTimeMode(fmi2Component c) {
    (void)c;
    return fmi2OK;
}

fmi2Status fmi2CompletedIntegratorStep(fmi2Component c, fmi2Boolean final, fmi2Boolean *event, fmi2Boolean *end) {
    (void)c; (void)final;
    *event = *end = fmi2False;
    return fmi2OK;
}

fmi2Status fmi2SetTime(fmi2Component c, fmi2Real time) {
    ((Instance *)c)->now.t = time;
    return fmi2OK;
}

fmi2Status fmi2SetContinuousStates(fmi2Component c, const fmi2Real x[], size_t count) {
    memcpy(((Instance *)c)->now.x, x, count * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetContinuousStates(fmi2Component c, fmi2Real x[], size_t count) {
    memcpy(x, ((Instance *)c)->now.x, count * sizeof *x);
    return fmi2OK;
}

fmi2Status fmi2GetDerivatives(fmi2Component c, fmi2Real dx[], size_t count) {
    Values *now = &((Instance *)c)->now;
    double all[MODEL_STATES + 1];
    model_derivative(now->p, now->x, now->u, now->t, all);
    memcpy(dx, all, count * sizeof *dx);
    return fmi2OK;
}

fmi2Status fmi2GetEventIndicators(fmi2Component c, fmi2Real indicators[], size_t count) {
    (void)c; (void)indicators; (void)count;
    return fmi2OK;
}

fmi2Status fmi2GetNominalsOfContinuousStates(fmi2Component c, fmi2Real nominals[], size_t count) {
    (void)c;
    for (size_t i = 0; i < count; i++) nominals[i] = 1.0;
    return fmi2OK;
}

/* co-simulation */

fmi2Status fmi2SetRealInputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                       const fmi2Integer order[], const fmi2Real value[]) {
    Instance *instance = c;
    for (size_t i = 0; i < count; i++) {
        long long at = vr[i];
        if (at < FIRST_INPUT || at >= FIRST_OUTPUT || order[i] != 1)
            return fault(instance, fmi2Error, "fmi2SetRealInputDerivatives: inputs have derivatives of order 1");
        instance->now.slope[at - FIRST_INPUT] = value[i];
    }
    return fmi2OK;
}

fmi2Status fmi2GetRealOutputDerivatives(fmi2Component c, const fmi2ValueReference vr[], size_t count,
                                        const fmi2Integer order[], fmi2Real value[]) {
    (void)vr; (void)count; (void)order; (void)value;
    return fault(c, fmi2Error, "derivatives of outputs are not provided");
}

/* dx/dt at x + share * k, with inputs as they are `after` seconds later */
static void rate(const Values *now, double after, double share, const double *k, double *dx) {
    double x[MODEL_STATES + 1], u[MODEL_INPUTS + 1];
    for (int i = 0; i < MODEL_STATES; i++) x[i] = now->x[i] + share * k[i];
    for (int i = 0; i < MODEL_INPUTS; i++) u[i] = now->u[i] + after * now->slope[i];
    model_derivative(now->p, x, u, now->t + after, dx);
}

/* one Runge-Kutta step of fourth order */
static void step(Values *now, double h) {
    double k[4][MODEL_STATES + 1];
    static const double none[MODEL_STATES + 1];
    rate(now, 0.0, 0.0, none, k[0]);
    rate(now, 0.5 * h, 0.5 * h, k[0], k[1]);
    rate(now, 0.5 * h, 0.5 * h, k[1], k[2]);
    rate(now, h, h, k[2], k[3]);
    for (int i = 0; i < MODEL_STATES; i++) now->x[i] += h / 6.0 * (k[0][i] + 2.0 * k[1][i] + 2.0 * k[2][i] + k[3][i]);
    for (int i = 0; i < MODEL_INPUTS; i++) now->u[i] += h * now->slope[i];
    now->t += h;
}

fmi2Status fmi2DoStep(fmi2Component c, fmi2Real time, fmi2Real length, fmi2Boolean final) {
    Instance *instance = c;
    Values *now = &instance->now;
    double steps = ceil(length / MODEL_STEP - 1e-9);
    (void)final;
    if (!(length >= 0.0) || !(steps < 1e9)) return fault(instance, fmi2Error, "fmi2DoStep: no step of this length");
    if (steps < 1.0) steps = 1.0;
    now->t = time;
    for (double i = 0.0; i < steps; i += 1.0) step(now, length / steps);
    now->t = time + length;
    memset(now->slope, 0, sizeof now->slope);
    for (int i = 0; i < MODEL_STATES; i++)
        if (!isfinite(now->x[i])) return fault(instance, fmi2Error, "fmi2DoStep: a state has left the range of numbers");
    return fmi2OK;
}

fmi2Status fmi2CancelStep(fmi2Component c) { return fault(c, fmi2Error, "fmi2CancelStep: steps are taken at once"); }

#define NO_STATUS(function, type) \
    fmi2Status function(fmi2Component c, const fmi2StatusKind kind, type *value) { \
        (void)c; (void)kind; (void)value; \
        return fmi2Discard; \
    }
NO_STATUS(fmi2GetStatus, fmi2Status)
NO_STATUS(fmi2GetRealStatus, fmi2Real)
NO_STATUS(fmi2GetIntegerStatus, fmi2Integer)
NO_STATUS(fmi2GetBooleanStatus, fmi2Boolean)
NO_STATUS(fmi2GetStringStatus, fmi2String)
