/* losses_card.c - .losses [from=t] [to=t] [in=element,...] [out=element,...] */

#include "reader.h"
#include "result_cards.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static const char USAGE[] = ".losses [from=t] [to=t] [in=v1,v2,...] [out=r1,r2,...]";

/* The elements behind in= or out=: up to the next parameter. */
static bool read_elements(struct dalcs_reader *reader, int **list, int *n) {
    struct dalcs_builder *builder = reader->builder;
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    int *found =
        dalcs_arena_alloc(&builder->circuit->arena, (size_t)reader->card->n, sizeof *found);
    if (found == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    *n = 0;
    do {
        const struct dalcs_token *name;
        if (!dalcs_reader_name(reader, "an element", &name)) {
            return false;
        }
        const int device = dalcs_builder_find_device(builder, name);
        if (device < 0) {
            return false;
        }
        for (int k = 0; k < *n; k++) {
            if (found[k] == device) {
                dalcs_builder_error(builder, name, USAGE, "'%s' is named twice", name->text);
                return false;
            }
        }
        found[(*n)++] = device;
        const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
        const struct dalcs_token *equal = dalcs_reader_peek(reader, 1);
        if (next == NULL || next->kind != DALCS_TOKEN_WORD ||
            (equal != NULL && equal->kind == DALCS_TOKEN_EQUAL)) {
            break;
        }
    } while (true);
    *list = found;
    if (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    return true;
}

static bool read_time(struct dalcs_reader *reader, const char *name, double *time) {
    const struct dalcs_token *place = dalcs_reader_peek(reader, 0);
    if (!dalcs_reader_number(reader, DALCS_SECOND, "a time", time)) {
        return false;
    }
    if (!(*time >= 0.0)) {
        dalcs_builder_error(reader->builder, place, USAGE, "%s cannot be negative", name);
        return false;
    }
    return true;
}

/* Is there a waveform whose losses may be asked for? */
static bool has_waveform(const struct dalcs_builder *builder) {
    return builder->analyses.tran != NULL || builder->analyses.pss != NULL ||
           builder->netlist->asks.steady;
}

/* Of a window within the run. */
static void check_window(struct dalcs_builder *builder, const struct dalcs_token *from,
                         const struct dalcs_token *to) {
    const struct dalcs_losses_card *card = builder->circuit->results.losses;
    const double stop = builder->circuit->analyses.transient.stop;
    const struct dalcs_token *either = from != NULL ? from : to;
    if (builder->analyses.tran == NULL && either != NULL) {
        dalcs_builder_error(builder, either, "leave from= and to= out",
                            "there is no .tran for this window: the losses of a steady state are "
                            "those of its whole orbit");
    } else if (to != NULL && card->to > stop) {
        dalcs_builder_error(builder, to, USAGE, "the window ends at %g s, the run at %g s",
                            card->to, stop);
    } else if (from != NULL && !(card->from < fmin(card->to, stop))) {
        dalcs_builder_error(builder, from, USAGE,
                            "the window begins at %g s, which is not before its end at %g s",
                            card->from, fmin(card->to, stop));
    } else if (to != NULL && !(card->from < card->to)) {
        dalcs_builder_error(builder, to, USAGE, "the window ends at %g s, before it begins",
                            card->to);
    }
}

static struct dalcs_losses_card *make_card(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    if (circuit->results.losses == NULL) {
        circuit->results.losses =
            dalcs_arena_alloc(&circuit->arena, 1, sizeof *circuit->results.losses);
        builder->out_of_memory = builder->out_of_memory || circuit->results.losses == NULL;
        if (circuit->results.losses != NULL) {
            *circuit->results.losses = (struct dalcs_losses_card){.to = INFINITY};
        }
    }
    return circuit->results.losses;
}

void dalcs_losses_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    struct dalcs_losses_card *losses = make_card(builder);
    const struct dalcs_token *window[2] = {NULL, NULL};
    if (losses == NULL) {
        return;
    }
    if (losses->present) {
        dalcs_builder_error(builder, card->token, NULL, "a second .losses: there is one window");
        return;
    }
    if (!has_waveform(builder)) {
        dalcs_builder_note(builder, card->token, NULL,
                           "there is no .tran and no .pss: this is left out");
        return;
    }
    losses->present = true;
    losses->where = dalcs_builder_keep_location(builder, card->token);
    while (!dalcs_reader_at_end(&reader)) {
        const struct dalcs_token *name = dalcs_reader_take_parameter(&reader);
        bool is_read = false;
        if (name == NULL) {
            dalcs_reader_unexpected(&reader);
        } else if (strcmp(name->text, "from") == 0 || strcmp(name->text, "to") == 0) {
            const bool is_to = name->text[0] == 't';
            window[is_to] = dalcs_reader_peek(&reader, 0);
            is_read = read_time(&reader, name->text, is_to ? &losses->to : &losses->from);
        } else if (strcmp(name->text, "in") == 0) {
            is_read = read_elements(&reader, &losses->in, &losses->n_in);
        } else if (strcmp(name->text, "out") == 0) {
            is_read = read_elements(&reader, &losses->out, &losses->n_out);
        } else {
            dalcs_builder_error(builder, name, USAGE, "unknown parameter '%s'", name->text);
        }
        if (!is_read) {
            builder->failed = true;
            return;
        }
    }
    check_window(builder, window[0], window[1]);
}

/* ---- When all elements are known ------------------------------------------------------------- */

/* The devices that read a gate's input: a switch and a resistor without a current, on a node of their own. */
static bool is_of_a_comparator(const struct dalcs_circuit *circuit, const struct dalcs_device *d) {
    bool is = false;
    for (int k = 0; k < circuit->control.n_comparators && !is; k++) {
        is = circuit->device[circuit->control.comparator[k]].node[0] == d->node[0];
    }
    return is;
}

/* The options of the command line replace the card. */
static bool take_request(struct dalcs_builder *builder) {
    const struct dalcs_losses_request *request = &builder->netlist->asks.losses;
    if (!request->is_asked || !has_waveform(builder)) {
        return true;
    }
    struct dalcs_losses_card *losses = make_card(builder);
    if (losses == NULL) {
        return false;
    }
    losses->present = true;
    if (request->has_window && builder->analyses.tran == NULL) {
        const struct dalcs_location where = {.file = builder->netlist->name};
        dalcs_builder_error_at(builder, &where, "write --losses",
                               "--losses: there is no .tran for a window: the losses of a steady "
                               "state are those of its whole orbit");
    } else if (request->has_window) {
        const struct dalcs_location where = {.file = builder->netlist->name};
        const double stop = builder->circuit->analyses.transient.stop;
        losses->from = request->from;
        losses->to = request->to;
        if (!(losses->from < fmin(losses->to, stop)) ||
            (isfinite(losses->to) && losses->to > stop)) {
            dalcs_builder_error_at(
                builder, &where, NULL,
                "--losses: %g s to %g s is not a window of the run from 0 to %g s", losses->from,
                fmin(losses->to, stop), stop);
        }
    }
    return true;
}

static int measure(struct dalcs_builder *builder, struct dalcs_signal signal, const char *format,
                   const char *name) {
    signal.name = dalcs_arena_printf(&builder->circuit->arena, format, name);
    return dalcs_signals_measure(builder, signal);
}

void dalcs_losses_collect(struct dalcs_builder *builder) {
    struct dalcs_circuit *circuit = builder->circuit;
    if (!take_request(builder)) {
        return;
    }
    if (circuit->results.losses == NULL || !circuit->results.losses->present) {
        if (builder->results.switchloss != NULL) {
            dalcs_builder_note(builder, builder->results.switchloss,
                               "add a line .losses, or run with --losses",
                               "no losses are computed: this card has no effect");
        }
        return;
    }
    struct dalcs_loss_device *device =
        dalcs_arena_alloc(&circuit->arena, (size_t)circuit->n_devices, sizeof *device);
    if (device == NULL) {
        builder->out_of_memory = true;
        return;
    }
    for (int k = 0; k < circuit->n_devices && !builder->out_of_memory; k++) {
        const struct dalcs_device *d = &circuit->device[k];
        device[k] = (struct dalcs_loss_device){-1, -1, {-1, -1}};
        if (dalcs_device_is_short(d) || is_of_a_comparator(circuit, d)) {
            continue;
        }
        device[k].voltage = measure(builder,
                                    (struct dalcs_signal){.kind = DALCS_SIGNAL_VOLTAGE,
                                                          .device = -1,
                                                          .node = {d->node[0], d->node[1]}},
                                    "v across %s", d->name);
        device[k].current =
            measure(builder, (struct dalcs_signal){.kind = DALCS_SIGNAL_CURRENT, .device = k},
                    "i(%s)", d->name);
    }
    circuit->results.losses->device = device;
    dalcs_switchloss_collect(builder);
}
