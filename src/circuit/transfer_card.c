/* transfer_card.c - .tf: the output and the source of a transfer function, and the current source that asks for the
 * resistance of the output. */
#include "analysis_cards.h"
#include "result_cards.h"

#include <string.h>

static const char TF_USAGE[] = ".tf v(a) source, .tf v(a,b) source or .tf i(vsource) source";

/* A V or I source by its name; -1 after a message. */
static int read_source(struct dalcs_reader *reader, const char *letters, const char *what) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name;
    if (!dalcs_reader_name(reader, what, &name)) {
        return -1;
    }
    const int index = dalcs_builder_find_device(builder, name);
    const struct dalcs_device *d = index >= 0 ? &builder->circuit->device[index] : NULL;
    const bool is_source = d != NULL && strchr(letters, d->letter) != NULL && d->stimulus >= 0 &&
                           (d->kind == DALCS_VSOURCE || d->kind == DALCS_ISOURCE);
    if (d != NULL && !is_source) {
        dalcs_builder_error(builder, name, TF_USAGE, "'%s' is %s: .tf needs %s here", name->text,
                            dalcs_builder_kind_text(d->kind), what);
    }
    return is_source ? index : -1;
}

static bool read_voltage(struct dalcs_reader *reader, int node[2]) {
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *name = dalcs_reader_peek(reader, 0);
    node[1] = 0;
    for (int k = 0; k < 2; k++) {
        if (!dalcs_reader_name(reader, "a node", &name)) {
            return false;
        }
        node[k] = dalcs_builder_find_node(builder, name);
        if (node[k] < 0) {
            return false;
        }
        if (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
            if (node[0] == node[1]) {
                dalcs_builder_error(builder, name, TF_USAGE,
                                    "the output of .tf is the voltage between a node and itself");
            }
            return node[0] != node[1];
        }
    }
    dalcs_reader_missing(reader, "')'");
    return false;
}

/* 1 A through it flows into node[0] and out of node[1]; in other analyses it is 0 A. */
static void add_probe(struct dalcs_builder *builder, const struct dalcs_card *card,
                      struct dalcs_transfer_card *tf) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *d =
        dalcs_builder_add_inner_device(builder, DALCS_ISOURCE, "probe", card->token);
    if (d == NULL) {
        return;
    }
    d->node[0] = tf->node[1];
    d->node[1] = tf->node[0];
    d->stimulus = circuit->n_stimuli++;
    circuit->stimulus[d->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true};
    tf->probe = d->stimulus;
}

/* The current of a device, or its voltage, as one of the measured signals. */
static int measure(struct dalcs_builder *builder, int device, const int *node) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_signal signal = {.kind = DALCS_SIGNAL_VOLTAGE, .device = -1};
    if (device >= 0) {
        signal.kind = DALCS_SIGNAL_CURRENT;
        signal.device = builder->elements.current_of[device];
        signal.name = circuit->device[device].name;
    } else {
        signal.node[0] = node[0];
        signal.node[1] = node[1];
        signal.name = "v";
    }
    return dalcs_signals_measure(builder, signal);
}

static const char *print_name(struct dalcs_builder *builder, const char *format, const char *name) {
    const char *text = dalcs_arena_printf(&builder->circuit->arena, format, name);
    builder->out_of_memory = builder->out_of_memory || text == NULL;
    return text;
}

/* v(a), v(a,b) or i(v1); its text is the card's. */
static bool read_output(struct dalcs_reader *reader, struct dalcs_transfer_card *tf,
                        const char **text) {
    struct dalcs_builder *builder = reader->builder;
    const bool is_voltage = dalcs_reader_take_word(reader, "v");
    if (!is_voltage && !dalcs_reader_take_word(reader, "i")) {
        dalcs_reader_missing(reader, "v(a), v(a,b) or i(vsource)");
        return false;
    }
    if (!dalcs_reader_take(reader, DALCS_TOKEN_OPEN)) {
        dalcs_reader_missing(reader, "'('");
        return false;
    }
    const int first = reader->at;
    if (is_voltage) {
        if (!read_voltage(reader, tf->node)) {
            return false;
        }
    } else {
        tf->output_device = read_source(reader, "v", "a V source");
        if (tf->output_device < 0) {
            return false;
        }
        if (!dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
            dalcs_reader_missing(reader, "')'");
            return false;
        }
    }
    const struct dalcs_token *token = &reader->card->token[first];
    const char *other = reader->at - first == 3 ? token[1].text : NULL;
    *text = other == NULL
                ? dalcs_builder_hint(builder, "%s(%s)", is_voltage ? "v" : "i", token->text)
                : dalcs_builder_hint(builder, "v(%s,%s)", token->text, other);
    return *text != NULL;
}

void dalcs_transfer_card_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_transfer_card tf = {.output_device = -1, .probe = -1};
    struct dalcs_reader reader = dalcs_reader_start(builder, card, TF_USAGE);
    const char *output;
    if (!dalcs_analysis_is_first(builder, card, &builder->analyses.tf) ||
        !read_output(&reader, &tf, &output)) {
        return;
    }
    tf.source = read_source(&reader, "vi", "a V or I source");
    if (tf.source < 0 || !dalcs_reader_end(&reader)) {
        return;
    }
    const struct dalcs_device source = circuit->device[tf.source];
    tf.source_is_voltage = source.kind == DALCS_VSOURCE;
    tf.output = measure(builder, tf.output_device, tf.node);
    tf.input = measure(builder, tf.source_is_voltage ? tf.source : -1, source.node);
    if (tf.output_device < 0) {
        add_probe(builder, card, &tf);
    }
    tf.where = dalcs_builder_keep_location(builder, card->token);
    tf.name[DALCS_TRANSFER_GAIN] = "transfer_function";
    tf.name[DALCS_TRANSFER_OUTPUT] =
        tf.output_device < 0
            ? print_name(builder, "output_impedance_at_%s", output)
            : print_name(builder, "%s#output_impedance", circuit->device[tf.output_device].name);
    tf.name[DALCS_TRANSFER_INPUT] = print_name(builder, "%s#input_impedance", source.name);
    tf.present = true;
    circuit->analyses.transfer = tf;
}
