/* fuzz_run.c - libFuzzer target: any bytes to a valid netlist (random_netlist.h), which is read and run.
 *
 * It may have no answer, but says so: reading refuses impossible loops and nodes alone, no status is an
 * internal error, a failed run has a message, messages are whole, times ascend and values are numbers.
 * Little is done: a run ends after so many rows and calls. With DALCS_FUZZ_PRINT in the environment the netlist is
 * printed. */
#include "dalcs.h"
#include "random_netlist.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

/* Most runs are short, so that there may be many: what breaks at all mostly breaks in the first steps. Netlists of
 * more bytes than FEW_BYTES run on. */
enum { MOST_ROWS = 2000, FEW_ROWS = 40, FEW_BYTES = 64, MOST_CALLS = 0 };

struct rows {
    size_t n_values;
    int most;
    bool ascends; /* the scale does: of .tran and .ac */
    double last;
    int n, n_calls;
};

#define require(condition) require_that(condition, #condition, __LINE__)

static void require_that(bool condition, const char *text, int line) {
    if (!condition) {
        fprintf(stderr, "fuzz_run.c:%d: not so: %s\n", line, text);
        abort();
    }
}

static enum dalcs_status begin(void *user, const struct dalcs_plot *plot) {
    struct rows *r = user;
    r->n_values = plot->n_signals * (plot->is_complex ? 2 : 1);
    r->ascends = plot->analysis == DALCS_TRANSIENT || plot->analysis == DALCS_AC;
    r->last = 0.0;
    return DALCS_OK;
}

static enum dalcs_status row(void *user, double time, const double *value) {
    struct rows *r = user;
    require(isfinite(time) && (!r->ascends || time >= r->last));
    r->last = time;
    for (size_t k = 0; k < r->n_values; k++) {
        require(isfinite(value[k]));
    }
    return ++r->n > r->most ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status progress(void *user, double time, double stop) {
    struct rows *r = user;
    require(isfinite(time) && isfinite(stop));
    return ++r->n_calls > MOST_CALLS ? DALCS_E_CANCELLED : DALCS_OK;
}

/* Whether all messages are whole, and how many are errors. */
static size_t check_messages(const struct dalcs_session *s, bool print) {
    size_t n_errors = 0;
    for (size_t k = 0; k < dalcs_session_n_messages(s); k++) {
        enum dalcs_level level;
        const char *text = dalcs_session_message(s, k, &level);
        require(text != NULL && strlen(text) > 8);
        if (print) {
            fprintf(stderr, "%s\n", text);
        }
        require(strstr(text, "(null)") == NULL && strstr(text, "internal error") == NULL);
        n_errors += level == DALCS_LEVEL_ERROR;
    }
    return n_errors;
}

static void check_report(const struct dalcs_report *report) {
    double last = 0.0;
    for (size_t k = 0; k < report->n_events; k++) {
        require(report->event[k].time >= last && report->event[k].element != NULL);
        last = report->event[k].time;
    }
    require(isfinite(report->certificate.worst));
}

static void run(struct dalcs_session *s, bool is_short, bool print) {
    struct rows rows = {.most = is_short ? FEW_ROWS : MOST_ROWS};
    struct dalcs_run_options options = dalcs_run_options_default();
    const struct dalcs_sink sink = {
        .user = &rows, .begin = begin, .row = row, .progress = progress};
    options.record = true;
    options.max_events = is_short ? 50 : 2000;
    options.max_outer = 5; /* in singular modes the least norm may take seconds to find */
    options.max_pivots = 5;
    options.cache_bytes = (size_t)1 << 20;
    const enum dalcs_status status = dalcs_session_run(s, &options, &sink);
    const size_t n_errors = check_messages(s, print);
    if (print) {
        fprintf(stderr, "status %d\n", status);
    }
    switch (status) {
    case DALCS_OK:
        require(n_errors == 0);
        break;
    case DALCS_SINGULAR:
    case DALCS_NOT_CONVERGED:
    case DALCS_INFEASIBLE:
    case DALCS_REFUTED:
    case DALCS_E_NETLIST:
    case DALCS_E_LIMIT:
    case DALCS_E_OPTION:
        require(n_errors > 0);
        break;
    default:
        require(status == DALCS_E_CANCELLED);
        break;
    }
    if (dalcs_session_report(s) != NULL) {
        check_report(dalcs_session_report(s));
    }
}

/* What the graph alone makes impossible, an .ic across a short too, and what is no switch, no logic of a .tran or no linear
 * formula where only those can be, is told when the netlist is read, and nothing else may be wrong. */
static bool is_expected(const char *text) {
    static const char *const expected[] = {"nothing limits the current",
                                           "nothing but",
                                           "short",
                                           "linear region",
                                           "is an amplifier",
                                           "is a follower",
                                           "is longer than a pulse",
                                           "division by 0",
                                           "is not finite",
                                           "is not a number",
                                           "larger than any number",
                                           "a power of"};
    for (size_t k = 0; k < sizeof expected / sizeof *expected; k++) {
        if (strstr(text, expected[k]) != NULL) {
            return true;
        }
    }
    return false;
}

static void check_refusal(const struct dalcs_session *s, enum dalcs_status status) {
    require(status == DALCS_E_NETLIST);
    require(check_messages(s, false) > 0);
    for (size_t k = 0; k < dalcs_session_n_messages(s); k++) {
        enum dalcs_level level;
        const char *text = dalcs_session_message(s, k, &level);
        if (level == DALCS_LEVEL_ERROR && !is_expected(text)) {
            fprintf(stderr, "%s\n", text);
            require(is_expected(text));
        }
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size) {
    static const char *print;
    static bool asked;
    char text[RANDOM_NETLIST_SIZE];
    struct dalcs_session *s;
    random_netlist(data, size, text);
    if (!asked) {
        print = getenv("DALCS_FUZZ_PRINT");
        asked = true;
    }
    if (print != NULL) {
        fputs(text, stderr);
    }
    require(dalcs_session_create(&s) == DALCS_OK);
    const enum dalcs_status status = dalcs_session_read_text(s, "fuzz.cir", text, strlen(text));
    if (status == DALCS_OK) {
        run(s, size <= FEW_BYTES, print != NULL);
    } else {
        check_refusal(s, status);
    }
    dalcs_session_destroy(s);
    return 0;
}
