/* computed.c - columns that are computed from signals, row by row: .print tran {v(a)*i(r1)} w(d1).
 *
 * The formula, whose names are those of the flat netlist, becomes steps as a measurement has them. The signals in it
 * are recorded as measured ones are: they are in no result by themselves. */

#include "result_cards.h"

#include <stdlib.h>
#include <string.h>

/* Steps as they come. */
struct steps {
    struct dalcs_builder *builder;
    struct dalcs_signal_formula_step *step; /* heap */
    size_t n, capacity;
    int height, deepest;
    bool failed; /* an error was reported, or there is no such step */
};

static void put(struct steps *s, struct dalcs_signal_formula_step step, int higher) {
    if (dalcs_grow(&s->step, &s->capacity, s->n + 1, sizeof *s->step) != DALCS_OK) {
        s->builder->out_of_memory = true;
        s->failed = true;
        return;
    }
    s->step[s->n++] = step;
    s->height += higher;
    s->deepest = s->height > s->deepest ? s->height : s->deepest;
}

static void put_signal(struct steps *s, struct dalcs_signal signal) {
    if (signal.name != NULL) {
        const int index = dalcs_signals_measure(s->builder, signal);
        put(s, (struct dalcs_signal_formula_step){.push = DALCS_PUT_SIGNAL, .index = index}, 1);
        s->failed = s->failed || index < 0;
    } else {
        s->builder->out_of_memory = true;
        s->failed = true;
    }
}

static void put_named(struct steps *s, const struct dalcs_formula *f) {
    struct dalcs_builder *builder = s->builder;
    struct dalcs_arena *arena = &builder->circuit->arena;
    struct dalcs_signal signal = {.kind = DALCS_SIGNAL_VOLTAGE, .device = -1};
    const struct dalcs_token *const *name = f->signal;
    if (f->kind == DALCS_FORMULA_CURRENT) {
        const int device = dalcs_builder_find_device(builder, name[0]);
        signal.kind = DALCS_SIGNAL_CURRENT;
        signal.device = device >= 0 ? builder->elements.current_of[device] : -1;
        s->failed = s->failed || device < 0;
        signal.name = dalcs_arena_printf(arena, "i(%s)", name[0]->text);
    } else {
        for (int k = 0; k < 2 && name[k] != NULL; k++) {
            signal.node[k] = dalcs_builder_find_node(builder, name[k]);
            s->failed = s->failed || signal.node[k] < 0;
        }
        signal.name = name[1] == NULL
                          ? dalcs_arena_printf(arena, "v(%s)", name[0]->text)
                          : dalcs_arena_printf(arena, "v(%s,%s)", name[0]->text, name[1]->text);
    }
    if (!s->failed) {
        put_signal(s, signal);
    }
}

static void put_formula(struct steps *s, const struct dalcs_formula *f);

/* A jump over what `part` becomes and `more` steps. */
static void put_jump_over(struct steps *s, enum dalcs_operation_code code, int higher,
                          const struct dalcs_formula *part, int more) {
    const size_t at = s->n;
    put(s, (struct dalcs_signal_formula_step){.code = code}, higher);
    put_formula(s, part);
    if (!s->failed) {
        s->step[at].count = (int)(s->n - at) + more;
    }
}

static void put_call(struct steps *s, const struct dalcs_formula *f) {
    const struct dalcs_function *function =
        dalcs_function_find(f->function, s->builder->netlist->dialect.name);
    if (function == NULL || f->n < function->least || f->n > function->most) {
        s->failed = true;
        return;
    }
    for (int k = 0; k < f->n; k++) {
        put_formula(s, f->argument[k]);
    }
    put(s,
        (struct dalcs_signal_formula_step){.code = DALCS_CALL, .function = function, .count = f->n},
        1 - f->n);
}

static void put_operation(struct steps *s, const struct dalcs_formula *f) {
    put_formula(s, f->argument[0]);
    if (f->code == DALCS_JUMP_AND || f->code == DALCS_JUMP_OR) {
        put_jump_over(s, f->code, -1, f->argument[1], 1);
        put(s, (struct dalcs_signal_formula_step){.code = DALCS_TO_LOGIC}, 0);
        return;
    }
    if (f->n > 1) {
        put_formula(s, f->argument[1]);
    }
    put(s, (struct dalcs_signal_formula_step){.code = f->code}, f->n > 1 ? -1 : 0);
}

static void put_formula(struct steps *s, const struct dalcs_formula *f) {
    if (s->failed) {
        return;
    }
    switch (f->kind) {
    case DALCS_FORMULA_NUMBER:
        put(s, (struct dalcs_signal_formula_step){.push = DALCS_PUT_VALUE, .number = f->number}, 1);
        break;
    case DALCS_FORMULA_TIME:
        put(s, (struct dalcs_signal_formula_step){.push = DALCS_PUT_TIME}, 1);
        break;
    case DALCS_FORMULA_VOLTAGE:
    case DALCS_FORMULA_CURRENT:
        put_named(s, f);
        break;
    case DALCS_FORMULA_OPERATION:
        put_operation(s, f);
        break;
    case DALCS_FORMULA_CHOICE:
        put_formula(s, f->argument[0]);
        put_jump_over(s, DALCS_JUMP_IF_ZERO, -1, f->argument[1], 1);
        s->height -= 1; /* one of the two is there */
        put_jump_over(s, DALCS_JUMP, 0, f->argument[2], 0);
        break;
    case DALCS_FORMULA_CALL:
        put_call(s, f);
        break;
    }
}

/* The steps into the circuit's arena. */
static bool finish(struct steps *s, struct dalcs_signal_formula *formula) {
    struct dalcs_builder *builder = s->builder;
    struct dalcs_signal_formula_step *step = NULL;
    if (!s->failed && s->deepest < DALCS_SIGNAL_FORMULA_DEEPEST) {
        step = dalcs_arena_alloc(&builder->circuit->arena, s->n, sizeof *step);
        builder->out_of_memory = builder->out_of_memory || step == NULL;
    }
    if (step != NULL) {
        memcpy(step, s->step, s->n * sizeof *step);
        *formula = (struct dalcs_signal_formula){.n = (int)s->n, .step = step, .text = ""};
    }
    free(s->step);
    return step != NULL;
}

bool dalcs_computed_compile(struct dalcs_builder *builder, const struct dalcs_formula *f,
                            struct dalcs_signal_formula *formula) {
    struct steps steps = {.builder = builder};
    put_formula(&steps, f);
    return finish(&steps, formula);
}

bool dalcs_computed_power(struct dalcs_builder *builder, int device,
                          struct dalcs_signal_formula *formula) {
    struct steps steps = {.builder = builder};
    struct dalcs_arena *arena = &builder->circuit->arena;
    const struct dalcs_device *d = &builder->circuit->device[device];
    put_signal(&steps, (struct dalcs_signal){.name = dalcs_arena_printf(arena, "v(%s)", d->name),
                                             .kind = DALCS_SIGNAL_VOLTAGE,
                                             .device = -1,
                                             .node = {d->node[0], d->node[1]}});
    put_signal(&steps, (struct dalcs_signal){.name = dalcs_arena_printf(arena, "i(%s)", d->name),
                                             .kind = DALCS_SIGNAL_CURRENT,
                                             .device = builder->elements.current_of[device]});
    put(&steps, (struct dalcs_signal_formula_step){.code = DALCS_MULTIPLY}, -1);
    return finish(&steps, formula);
}
