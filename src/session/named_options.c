/* named_options.c - a run's options by their names, for languages that do not read dalcs.h. */
#include "session_internal.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum kind { METHOD, CURVE, AUDIT, INJECTION, NAME, REAL, WHOLE, COUNT, YES_OR_NO };

static const struct {
    const char *name;
    enum kind kind;
    size_t offset;
} OPTION[] = {

#define AT(field) offsetof(struct dalcs_run_options, field)
    {"method", METHOD, AT(method)},
    {"tol", REAL, AT(tolerance)},
    {"stages", WHOLE, AT(stages)},
    {"step", REAL, AT(step)},
    {"fill", REAL, AT(fill)},
    {"curve", CURVE, AT(curve)},
    {"compress", REAL, AT(compress)},
    {"record", YES_OR_NO, AT(record)},
    {"energy", YES_OR_NO, AT(energy)},
    {"audit", AUDIT, AT(audit)},
    {"steady", YES_OR_NO, AT(steady)},
    {"period", REAL, AT(period)},
    {"bode", YES_OR_NO, AT(bode)},
    {"bode_from", REAL, AT(bode_from)},
    {"bode_to", REAL, AT(bode_to)},
    {"bode_points", WHOLE, AT(bode_points)},
    {"bode_loop", NAME, AT(loop)},
    {"bode_injection", INJECTION, AT(loop_is_loaded)},
    {"bode_sideband", WHOLE, AT(sideband)},
    {"envelope", YES_OR_NO, AT(envelope)},
    {"envelope_stop", REAL, AT(envelope_stop)},
    {"only", COUNT, AT(only_step)},
    {"workers", COUNT, AT(workers)},
#undef AT
};

enum { N_OPTIONS = sizeof OPTION / sizeof OPTION[0] };

const char *dalcs_run_option_name(size_t index) {
    return index < N_OPTIONS ? OPTION[index].name : NULL;
}

enum dalcs_status dalcs_run_options_create(struct dalcs_run_options **options) {
    *options = dalcs_alloc(1, sizeof **options);
    if (*options == NULL) {
        return DALCS_E_NOMEM;
    }
    dalcs_run_options_init(*options, sizeof **options);
    return DALCS_OK;
}

void dalcs_run_options_destroy(struct dalcs_run_options *options) {
    free(options);
}

/* The word of the list that `text` is, or -1; the list ends with NULL. */
static int find_word(const char *const *list, const char *text) {
    for (int k = 0; list[k] != NULL; k++) {
        if (strcmp(list[k], text) == 0) {
            return k;
        }
    }
    return -1;
}

/* Words live as long as the program, which is why options own nothing. */
static enum dalcs_status set_word(const char **field, const char *const *list, const char *text) {
    const int k = find_word(list, text);
    *field = k >= 0 ? list[k] : *field;
    return k >= 0 ? DALCS_OK : DALCS_E_OPTION;
}

static enum dalcs_status set_method(const char **field, const char *text) {
    for (size_t k = 0; dalcs_method_name(k) != NULL; k++) {
        if (strcmp(dalcs_method_name(k), text) == 0) {
            *field = dalcs_method_name(k);
            return DALCS_OK;
        }
    }
    return DALCS_E_OPTION;
}

static enum dalcs_status set_number(enum kind kind, void *field, const char *text) {
    double value = INFINITY;
    if (strcmp(text, "inf") != 0) {
        DALCS_TRY(dalcs_parse_number(text, &value));
    }
    if (kind == REAL) {
        *(double *)field = value;
        return DALCS_OK;
    }
    if (value != rint(value) || !(fabs(value) < 1e9)) {
        return DALCS_E_OPTION;
    }
    if (kind == COUNT && !(value >= 0.0)) {
        return DALCS_E_OPTION;
    }
    if (kind == COUNT) {
        *(size_t *)field = (size_t)value;
    } else {
        *(int *)field = (int)value;
    }
    return DALCS_OK;
}

enum dalcs_status dalcs_run_options_set(struct dalcs_run_options *options, const char *name,
                                        const char *text) {
    static const char *const curves[] = {"cubics", "lines", NULL};
    static const char *const audits[] = {"sample", "full", "off", NULL}; /* by their enum */
    static const char *const answers[] = {"no", "yes", NULL};
    static const char *const injections[] = {"voltage", "both", NULL};
    int option = 0;
    while (option < N_OPTIONS && strcmp(OPTION[option].name, name) != 0) {
        option++;
    }
    if (option == N_OPTIONS || OPTION[option].offset >= options->size) {
        return DALCS_E_OPTION;
    }
    void *field = (char *)options + OPTION[option].offset;
    const enum kind kind = OPTION[option].kind;
    if (kind == METHOD || kind == CURVE) {
        return kind == METHOD ? set_method(field, text) : set_word(field, curves, text);
    }
    if (kind == NAME) {
        *(const char **)field = text;
        return DALCS_OK;
    }
    if (kind == REAL || kind == WHOLE || kind == COUNT) {
        return set_number(kind, field, text);
    }
    const int k = find_word(kind == AUDIT       ? audits
                            : kind == INJECTION ? injections
                                                : answers,
                            text);
    if (k < 0) {
        return DALCS_E_OPTION;
    }
    if (kind == AUDIT) {
        options->audit = (enum dalcs_audit_mode)k;
    } else {
        *(bool *)field = k == 1;
    }
    return DALCS_OK;
}

void dalcs_run_options_set_times(struct dalcs_run_options *options, const double *at, size_t n) {
    static const double NO_TIME = 0.0;
    options->at = at != NULL || n > 0 ? at : &NO_TIME;
    options->n_at = n;
}

void dalcs_run_options_set_frequencies(struct dalcs_run_options *options, const double *at,
                                       size_t n) {
    options->bode_at = at;
    options->n_bode_at = n;
}
