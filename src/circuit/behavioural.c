/* behavioural.c - sources with a formula: B with V= or I=, E and G with VALUE or TABLE. */
#include "behaviour.h"

#include <stdlib.h>
#include <string.h>

/* A source that waits for all elements to be known. */
struct dalcs_formula_source {
    int device;
    const struct dalcs_token *token; /* its formula; NULL: the voltage of its controlling nodes */
    bool has_table;
    struct dalcs_piecewise table;
    const struct dalcs_gate *gate; /* once it is compiled: the values that it has, or NULL */
    bool is_resolved;              /* or about to be */
};

static const char USAGE[] =
    "a behavioural source is: Bname node node V=expression, or I=expression";

static struct dalcs_formula_source *add_source(struct dalcs_builder *builder,
                                               const struct dalcs_device *device) {
    if (dalcs_grow(&builder->formula, &builder->formula_capacity, builder->n_formulas + 1,
                   sizeof *builder->formula) != DALCS_OK) {
        builder->out_of_memory = true;
        return NULL;
    }
    struct dalcs_formula_source *source = &builder->formula[builder->n_formulas++];
    *source = (struct dalcs_formula_source){.device = (int)(device - builder->circuit->device)};
    return source;
}

/* A formula; `false` when an error was reported. */
static bool read_formula(struct dalcs_reader *reader, const struct dalcs_token **token) {
    *token = dalcs_reader_peek(reader, 0);
    if (*token == NULL) {
        dalcs_reader_missing(reader, "an expression");
        return false;
    }
    if ((*token)->kind == DALCS_TOKEN_BAD) {
        reader->builder->failed = true;
        return false;
    }
    if ((*token)->kind != DALCS_TOKEN_FORMULA) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    reader->at++;
    return true;
}

/* LTspice has B sources that are no sources. */
static void refuse(struct dalcs_builder *builder, const struct dalcs_token *what) {
    if (strcmp(what->text, "r") == 0) {
        dalcs_builder_error(builder, what, "write Rname node node R={expression} for a number",
                            "a resistance times its current is a product of signals, unless it is "
                            "a number");
    } else if (strcmp(what->text, "p") == 0) {
        dalcs_builder_error(builder, what, "write a resistor, or a current source I= of a table",
                            "a power over a voltage is no piecewise linear current");
    } else {
        dalcs_builder_error(builder, what, USAGE, "a behavioural source has no '%s='", what->text);
    }
}

void dalcs_behavioural_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, USAGE);
    int node[2];
    if (!dalcs_reader_nodes(&reader, 2, node)) {
        return;
    }
    const struct dalcs_token *what = dalcs_reader_take_parameter(&reader);
    if (what == NULL || strlen(what->text) != 1 || strchr("vi", *what->text) == NULL) {
        if (what != NULL) {
            refuse(builder, what);
        } else {
            dalcs_reader_missing(&reader, "V= or I=");
        }
        return;
    }
    struct dalcs_device *device = dalcs_builder_add_device(
        builder, *what->text == 'v' ? DALCS_VCVS : DALCS_VCCS, card->token);
    const struct dalcs_token *token;
    if (device == NULL) {
        return;
    }
    device->node[0] = node[0];
    device->node[1] = node[1];
    if (!read_formula(&reader, &token) || !dalcs_reader_end(&reader)) {
        return;
    }
    struct dalcs_formula_source *source = add_source(builder, device);
    if (source != NULL) {
        source->token = token;
    }
}

int dalcs_behavioural_parse_control(struct dalcs_reader *reader,
                                    const struct dalcs_token *element) {
    const struct dalcs_token *token;
    if (!read_formula(reader, &token)) {
        return -1;
    }
    struct dalcs_device *device =
        dalcs_builder_add_inner_device(reader->builder, DALCS_VCVS, "control", element);
    const int node = dalcs_builder_inner_node(reader->builder, "control", element);
    struct dalcs_formula_source *source =
        device != NULL ? add_source(reader->builder, device) : NULL;
    if (source == NULL || node < 0) {
        return -1;
    }
    device->node[0] = node;
    source->token = token;
    return node;
}

bool dalcs_behavioural_is_form(const struct dalcs_token *token) {
    static const char *const forms[] = {"value", "vol", "cur", "table"};
    return token != NULL && token->kind == DALCS_TOKEN_WORD &&
           dalcs_builder_is_one_of(token->text, forms, sizeof forms / sizeof forms[0]);
}

/* (x,y) (x,y) ..., with parentheses or without. */
static bool read_points(struct dalcs_reader *reader, struct dalcs_piecewise *table) {
    const size_t most = (size_t)reader->card->n;
    table->knot = dalcs_arena_alloc(&reader->builder->scratch, most, sizeof *table->knot);
    if (table->knot == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    do {
        double x;
        double y;
        while (dalcs_reader_take(reader, DALCS_TOKEN_OPEN)) {
        }
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "the x of a point", &x)) {
            return false;
        }
        const struct dalcs_token *place = dalcs_reader_previous(reader);
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "the y of a point", &y)) {
            return false;
        }
        while (dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        }
        if (table->n > 0 && !(x > table->knot[table->n - 1].at)) {
            dalcs_builder_error(reader->builder, place, "a jump is written with sgn() or u()",
                                "the x of a table must ascend");
            return false;
        }
        table->knot[table->n++] = (struct dalcs_knot){x, y, y, y};
    } while (!dalcs_reader_at_end(reader));
    return true;
}

void dalcs_behavioural_parse_form(struct dalcs_reader *reader, struct dalcs_device *device) {
    const struct dalcs_token *form = dalcs_reader_peek(reader, 0);
    const bool is_table = strcmp(form->text, "table") == 0;
    const struct dalcs_token *next;
    struct dalcs_piecewise table = {0};
    const struct dalcs_token *token = NULL;
    reader->usage = is_table ? "a table is: TABLE {expression} = (x1,y1) (x2,y2) ..."
                             : "such a source is: VALUE={expression}";
    reader->at++;
    dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    next = dalcs_reader_peek(reader, 0);
    const bool has_formula = next == NULL || next->kind == DALCS_TOKEN_FORMULA ||
                             next->kind == DALCS_TOKEN_BAD || !is_table;
    if (has_formula && !read_formula(reader, &token)) {
        return;
    }
    if (is_table && has_formula) {
        dalcs_reader_take(reader, DALCS_TOKEN_EQUAL);
    }
    if (is_table ? !read_points(reader, &table) : !dalcs_reader_end(reader)) {
        return;
    }
    struct dalcs_formula_source *source = add_source(reader->builder, device);
    if (source != NULL) {
        source->token = token;
        source->has_table = is_table;
        source->table = table;
    }
}

/* ---- When all elements are known --------------------------------------------------------------- */

static const struct dalcs_form *input_of(struct dalcs_compiler *c,
                                         const struct dalcs_formula_source *source,
                                         const struct dalcs_device *device) {
    if (source->token != NULL) {
        const struct dalcs_formula *formula = source->token->formula;
        c->n_forms = (size_t)formula->number_of + 1;
        c->form_of = dalcs_arena_alloc(c->arena, c->n_forms, sizeof(const struct dalcs_form *));
        c->builder->out_of_memory = c->builder->out_of_memory || c->form_of == NULL;
        return c->form_of != NULL ? dalcs_compile(c, formula) : NULL;
    }
    struct dalcs_affine sum = dalcs_affine_constant(0);
    for (int k = 0; k < 2; k++) {
        const int node = device->node[2 + k];
        const struct dalcs_affine v = dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, node);
        sum = node != 0 ? dalcs_affine_add(c, &sum, k == 0 ? 1 : -1, &v) : sum;
    }
    return dalcs_form_affine(c, &sum);
}

const struct dalcs_formula *dalcs_behavioural_formula_of(const struct dalcs_builder *builder,
                                                         int device) {
    size_t low = 0;
    size_t high = builder->n_formulas;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const bool is_before = builder->formula[middle].device < device;
        *(is_before ? &low : &high) = is_before ? middle + 1 : middle;
    }
    const struct dalcs_formula_source *source =
        low < builder->n_formulas ? &builder->formula[low] : NULL;
    const bool is_one = source != NULL && source->device == device && source->token != NULL;
    return is_one && !source->has_table ? source->token->formula : NULL;
}

static const struct dalcs_form *form_of(struct dalcs_compiler *c,
                                        const struct dalcs_formula_source *source) {
    c->n_waves = 0;
    c->n_cells = 0;
    c->n_pairs = 0;
    const struct dalcs_form *form =
        input_of(c, source, &c->builder->circuit->device[source->device]);
    return source->has_table ? dalcs_form_apply(c, &source->table, form) : form;
}

/* Without pairs for what sources alone decide, if any do. Products have made parts of their own, which know nothing of
 * that. */
static const struct dalcs_behaviour *decide(struct dalcs_compiler *c,
                                            const struct dalcs_formula_source *source,
                                            const struct dalcs_potentials *potentials,
                                            const struct dalcs_behaviour *written) {
    if (written == NULL || potentials->n == 0 || c->n_nodes > 0 ||
        !dalcs_potentials_reach(potentials, written)) {
        return written;
    }
    c->is_silent = true;
    c->potentials = potentials;
    const struct dalcs_form *form = form_of(c, source);
    struct dalcs_behaviour *made =
        form != NULL && !c->failed ? dalcs_behaviour_make(c, form) : NULL;
    c->potentials = NULL;
    c->is_silent = c->failed = false;
    if (made == NULL) {
        return written;
    }
    made->written = written;
    return made;
}

static void resolve(struct dalcs_compiler *c, struct dalcs_formula_source *source,
                    struct dalcs_potentials *potentials) {
    c->failed = false;
    c->n_nodes = 0;
    c->element = c->builder->device_token[source->device];
    const struct dalcs_form *form = form_of(c, source);
    /* products may have moved it */
    struct dalcs_device *device = &c->builder->circuit->device[source->device];
    const int control[2] = {device->node[2], device->node[3]};
    device->node[2] = device->node[3] = 0;
    if (form != NULL && !c->failed) {
        const struct dalcs_behaviour *written = dalcs_behaviour_make(c, form);
        source->gate = dalcs_gate_find(c, device, form);
        device->node[2] = control[0];
        device->node[3] = control[1];
        device->behaviour = decide(c, source, potentials, written);
        device->node[2] = device->node[3] = 0;
        dalcs_potentials_note(potentials, c->builder->circuit, source->device);
    }
}

/* ---- What is read first -------------------------------------------------------------------------- */

/* Formulas that read each other along a longer chain than this are resolved in the order of their cards: what sources
 * decide behind it has pairs. */
enum { LONGEST_CHAIN = 64 };

struct resolving {
    struct dalcs_compiler *compiler;
    struct dalcs_potentials *potentials;
    int *driver; /* [n_nodes] a source with a formula, and 1; 0: none */
    int n_nodes;
    int depth;
};

static void resolve_node(struct resolving *r, int node);

/* Parts that are used more than once are there once. */
static void resolve_read(struct resolving *r, const struct dalcs_formula *f, bool *seen) {
    if (seen[f->number_of]) {
        return;
    }
    seen[f->number_of] = true;
    for (int k = 0; f->kind == DALCS_FORMULA_VOLTAGE && k < 2; k++) {
        if (f->signal[k] != NULL) {
            resolve_node(r, dalcs_names_find(&r->compiler->builder->nodes, f->signal[k]->text));
        }
    }
    for (int k = 0; k < f->n; k++) {
        resolve_read(r, f->argument[k], seen);
    }
}

static void resolve_formula(struct resolving *r, const struct dalcs_formula *f) {
    bool *seen = dalcs_arena_alloc(r->compiler->arena, (size_t)f->number_of + 1, sizeof *seen);
    if (seen != NULL) {
        resolve_read(r, f, seen);
    } else {
        r->compiler->builder->out_of_memory = true;
    }
}

static void resolve_in_order(struct resolving *r, struct dalcs_formula_source *source) {
    if (source->is_resolved || r->depth > LONGEST_CHAIN || r->compiler->builder->out_of_memory) {
        return;
    }
    source->is_resolved = true;
    r->depth++;
    const struct dalcs_device *device = &r->compiler->builder->circuit->device[source->device];
    if (source->token != NULL) {
        resolve_formula(r, source->token->formula);
    } else {
        const int control[2] = {device->node[2], device->node[3]};
        resolve_node(r, control[0]);
        resolve_node(r, control[1]);
    }
    r->depth--;
    resolve(r->compiler, source, r->potentials);
}

static void resolve_node(struct resolving *r, int node) {
    if (node > 0 && node < r->n_nodes && r->driver[node] > 0) {
        resolve_in_order(r, &r->compiler->builder->formula[r->driver[node] - 1]);
    }
}

static void resolve_all(struct dalcs_compiler *c, struct dalcs_potentials *potentials) {
    struct dalcs_builder *builder = c->builder;
    const struct dalcs_circuit *circuit = builder->circuit;
    struct resolving r = {.compiler = c,
                          .potentials = potentials,
                          .driver = calloc((size_t)circuit->n_nodes, sizeof *r.driver),
                          .n_nodes = circuit->n_nodes};
    builder->out_of_memory = builder->out_of_memory || r.driver == NULL;
    for (size_t k = 0; k < builder->n_formulas && !builder->out_of_memory; k++) {
        const struct dalcs_device *device = &circuit->device[builder->formula[k].device];
        if (device->kind == DALCS_VCVS) {
            r.driver[device->node[0]] = (int)k + 1;
        }
    }
    for (size_t k = 0; k < builder->n_formulas; k++) {
        resolve_in_order(&r, &builder->formula[k]);
    }
    free(r.driver);
}

/* Those that formulas made come after those of V and I. */
static void take_stimuli(struct dalcs_compiler *c) {
    struct dalcs_circuit *circuit = c->builder->circuit;
    const size_t n = (size_t)circuit->n_stimuli;
    struct dalcs_stimulus *all = dalcs_arena_alloc(&circuit->arena, n + c->n_stimuli, sizeof *all);
    if (all == NULL) {
        c->builder->out_of_memory = true;
        return;
    }
    if (n > 0) {
        memcpy(all, circuit->stimulus, n * sizeof *all);
    }
    memcpy(all + n, c->stimulus, c->n_stimuli * sizeof *all);
    circuit->stimulus = all;
    circuit->n_stimuli += (int)c->n_stimuli;
}

void dalcs_behavioural_resolve(struct dalcs_builder *builder) {
    struct dalcs_compiler c = {.builder = builder, .arena = &builder->scratch};
    struct dalcs_potentials potentials = {0};
    if (builder->n_formulas > 0) {
        dalcs_potentials_find(&potentials, builder);
        resolve_all(&c, &potentials);
        dalcs_potentials_finish(&potentials);
    }
    struct dalcs_gate_readers readers = {0};
    for (size_t k = 0; k < builder->n_formulas && !builder->out_of_memory; k++) {
        if (builder->formula[k].gate != NULL) {
            dalcs_gate_settle(builder, &readers, builder->formula[k].gate);
        }
    }
    dalcs_gate_readers_finish(&readers);
    if (c.n_stimuli > 0 && !builder->out_of_memory) {
        take_stimuli(&c);
    }
    free(c.wave);
    free(c.cell);
    free(c.stimulus);
}
