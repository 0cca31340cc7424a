/* load_sweep.c - how far the voltage of a rectifier falls between two charges, over its load.
 *
 *   cc load_sweep.c $(pkg-config --cflags --libs dalcs) -o load_sweep && ./load_sweep
 */
#include <dalcs.h>
#include <signal.h>
#include <stdio.h>
#include <string.h>

static volatile sig_atomic_t interrupted;

static void note_interrupt(int number) {
    interrupted = number;
}

struct output {
    size_t column;
    double low, high; /* V, over the last period */
};

static enum dalcs_status find_output(void *user, const struct dalcs_plot *plot) {
    struct output *out = user;
    for (out->column = 0; out->column < plot->n_signals; out->column++) {
        if (strcmp(plot->name[out->column], "v(out)") == 0) {
            return DALCS_OK;
        }
    }
    return DALCS_E_OPTION; /* ends the run */
}

static enum dalcs_status take_row(void *user, double time, const double *value) {
    struct output *out = user;
    double v = value[out->column];
    if (time >= 0.1) {
        out->low = v < out->low ? v : out->low;
        out->high = v > out->high ? v : out->high;
    }
    return DALCS_OK;
}

/* A flag that another thread sets would do as well. */
static enum dalcs_status stop_if_interrupted(void *user, double time, double stop) {
    return (void)user, (void)time, (void)stop, interrupted ? DALCS_E_CANCELLED : DALCS_OK;
}

static enum dalcs_status simulate(double ohm, struct output *out) {
    char text[200];
    int length = snprintf(text, sizeof text,
                          "rectifier\nV1 in 0 SIN(0 10 50)\nD1 in out\n"
                          "C1 out 0 100u\nR1 out 0 %.17g\n.tran 10u 0.12 uic\n",
                          ohm);
    const struct dalcs_sink sink = {
        .user = out, .begin = find_output, .row = take_row, .progress = stop_if_interrupted};
    const struct dalcs_run_options options = dalcs_run_options_default();
    struct dalcs_session *s;
    enum dalcs_status status = dalcs_session_create(&s);
    if (status == DALCS_OK)
        status = dalcs_session_read_text(s, "sweep", text, (size_t)length);
    if (status == DALCS_OK)
        status = dalcs_session_run(s, &options, &sink);
    for (size_t k = 0; s && k < dalcs_session_n_messages(s); k++)
        fprintf(stderr, "%s\n", dalcs_session_message(s, k, NULL));
    dalcs_session_destroy(s);
    return status;
}

int main(void) {
    signal(SIGINT, note_interrupt);
    for (double ohm = 100.0; ohm < 4000.0; ohm *= 2.0) {
        struct output out = {.low = 1e9, .high = -1e9};
        enum dalcs_status status = simulate(ohm, &out);
        if (status != DALCS_OK)
            return fprintf(stderr, "%s\n", dalcs_status_text(status)), 1;
        printf("%6g ohm  %.6f V to %.6f V\n", ohm, out.low, out.high);
    }
    return 0;
}
