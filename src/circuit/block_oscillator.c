/* block_oscillator.c - cards of XSPICE's oscillators: triangle, square, sine, d_osc. */
#include "oscillator.h"

#include <math.h>
#include <string.h>

static bool read_hertz(struct dalcs_oscillator *o) {
    const struct dalcs_block_card *c = &o->card;
    struct dalcs_piecewise table;
    if (!dalcs_block_read_table(c, "cntl_array", "freq_array", &table)) {
        return false;
    }
    for (int k = 0; k < table.n; k++) {
        if (table.knot[k].value < 0) {
            dalcs_builder_error(c->builder, dalcs_block_find(c->block, "freq_array")->name, NULL,
                                "a frequency cannot be negative");
            return false;
        }
    }
    return dalcs_oscillator_set_hertz(o, &table);
}

static bool read_model(struct dalcs_oscillator *o) {
    static const char *const names[] = {"cntl_array", "freq_array", "out_low",  "out_high",
                                        "duty_cycle", "rise_time",  "fall_time"};
    static const char *const digital[] = {"cntl_array", "freq_array", "duty_cycle",
                                          "init_phase", "rise_delay", "fall_delay"};
    static const int n_names[] = {5, 7, 4};
    static const char usage[] = "an oscillator is: Aname control out model";
    const struct dalcs_block *block = o->card.block;
    const bool is_digital = o->shape == DALCS_OSCILLATOR_DIGITAL;
    if (!dalcs_block_check(&o->card, is_digital ? digital : names,
                           is_digital ? 6 : (size_t)n_names[o->shape], 2, usage) ||
        !read_hertz(o)) {
        return false;
    }
    o->low = dalcs_block_number(block, "out_low", is_digital ? 0 : -1);
    o->high = dalcs_block_number(block, "out_high", 1);
    o->duty = dalcs_block_number(block, "duty_cycle", 0.5);
    o->rise = is_digital ? 0 : dalcs_block_number(block, "rise_time", 1e-9);
    o->fall = is_digital ? 0 : dalcs_block_number(block, "fall_time", 1e-9);
    o->rise_delay = is_digital ? dalcs_block_number(block, "rise_delay", 1e-9) : 0;
    o->fall_delay = is_digital ? dalcs_block_number(block, "fall_delay", 1e-9) : 0;
    const double turns = dalcs_block_number(block, "init_phase", 0) / 360;
    o->phase = turns - floor(turns);
    const char *wrong = !(o->low < o->high)             ? "out_low must be below out_high"
                        : !(o->duty > 0 && o->duty < 1) ? "duty_cycle is above 0 and below 1"
                        : o->rise < 0 || o->fall < 0 || o->rise_delay < 0 || o->fall_delay < 0
                            ? "times and delays cannot be negative"
                            : NULL;
    if (wrong != NULL) {
        dalcs_builder_error(o->card.builder, block->type, NULL, "%s", wrong);
    }
    return wrong == NULL;
}

bool dalcs_block_parse_oscillator(const struct dalcs_block_card *c) {
    static const char *const types[] = {"triangle", "square", "sine", "d_osc"};
    if (!dalcs_builder_is_one_of(c->block->type->text, types, 4)) {
        return false;
    }
    struct dalcs_oscillator o = {.card = *c, .place = c->block->type};
    while (strcmp(c->block->type->text, types[o.shape]) != 0) {
        o.shape++;
    }
    if (read_model(&o)) {
        o.control = c->port[0].end[0];
        o.out = c->port[1].end[0];
        dalcs_oscillator_add(&o);
    } else {
        c->builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    }
    return true;
}
