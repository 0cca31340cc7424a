/* smooth_parts.c - products and smooth functions in a formula, each a voltage source between a node of its own and
 * ground that reads nodes. An argument that is not the voltage of a node is put out at one by a source, too. */
#include "behaviour.h"
#include "storage.h"

#include <string.h>

int dalcs_compiler_new_node(struct dalcs_compiler *c, const char *what) {
    const char *name = dalcs_arena_printf(&c->builder->scratch, "%s%d", what, ++c->n_nodes);
    const int node = name != NULL ? dalcs_builder_inner_node(c->builder, name, c->element) : -1;
    c->failed = c->failed || node < 0;
    return node;
}

int dalcs_compiler_add_source(struct dalcs_compiler *c, const char *what, int node,
                              const struct dalcs_behaviour *behaviour) {
    struct dalcs_builder *builder = c->builder;
    const char *name = dalcs_arena_printf(&builder->scratch, "%s%d", what, c->n_nodes);
    struct dalcs_device *device =
        name != NULL && dalcs_builder_reserve_devices(builder, 1)
            ? dalcs_builder_add_inner_device(builder, DALCS_VCVS, name, c->element)
            : NULL;
    if (device == NULL) {
        c->failed = true;
        return -1;
    }
    device->node[0] = node;
    device->behaviour = behaviour;
    return node;
}

/* The node that a form is the voltage of; -1: it is something else. */
static int plain_node(const struct dalcs_form *form) {
    const struct dalcs_affine *a = &form->affine;
    const bool is_plain = form->n == 0 && a->n == 1 && a->constant == 0.0 &&
                          a->term[0].kind == DALCS_QUANTITY_VOLTAGE &&
                          a->term[0].coefficient == 1.0;
    return is_plain ? a->term[0].index : -1;
}

int dalcs_compiler_node_at(struct dalcs_compiler *c, const char *what,
                           const struct dalcs_formula *f, bool is_part, int *source) {
    struct dalcs_compiler inner;
    if (!dalcs_compiler_start_inner(c, &inner, c->n_forms)) {
        return -1;
    }
    const struct dalcs_form *form = dalcs_compile(&inner, f);
    struct dalcs_behaviour *behaviour =
        form != NULL && !inner.failed ? dalcs_behaviour_make(&inner, form) : NULL;
    dalcs_compiler_finish_inner(c, &inner);
    const int node = behaviour != NULL && !c->failed ? dalcs_compiler_new_node(c, what) : -1;
    if (node < 0) {
        return -1;
    }
    behaviour->is_part = is_part;
    *source = c->builder->circuit->n_devices;
    return dalcs_compiler_add_source(c, what, node, behaviour);
}

/* The quantities that the source reads, as for other formulas. */
static bool list_arguments(struct dalcs_compiler *c, struct dalcs_behaviour *behaviour) {
    const struct dalcs_smooth *smooth = behaviour->smooth;
    struct dalcs_affine_term *term =
        dalcs_arena_alloc(&c->builder->circuit->arena, (size_t)smooth->n, sizeof *term);
    if (term == NULL) {
        return false;
    }
    struct dalcs_affine *reads = &behaviour->output;
    reads->term = term;
    for (int k = 0; k < smooth->n; k++) {
        const bool is_new =
            smooth->node[k] > 0 && !(reads->n > 0 && term[0].index == smooth->node[k]);
        if (is_new) {
            term[reads->n++] =
                (struct dalcs_affine_term){DALCS_QUANTITY_VOLTAGE, smooth->node[k], 1.0};
        }
    }
    return true;
}

static struct dalcs_behaviour *make(struct dalcs_compiler *c, const struct dalcs_smooth *what) {
    struct dalcs_arena *arena = &c->builder->circuit->arena;
    struct dalcs_behaviour *behaviour = dalcs_arena_alloc(arena, 1, sizeof *behaviour);
    struct dalcs_smooth *smooth = dalcs_arena_alloc(arena, 1, sizeof *smooth);
    if (behaviour != NULL && smooth != NULL) {
        *smooth = *what;
        *behaviour = (struct dalcs_behaviour){.smooth = smooth, .is_part = true};
    }
    if (behaviour == NULL || smooth == NULL || !list_arguments(c, behaviour)) {
        c->builder->out_of_memory = c->failed = true;
        return NULL;
    }
    return behaviour;
}

/* What is said of a function points at it, if it stands on the line where its element begins. */
static void point_at(const struct dalcs_formula *f, struct dalcs_device *device) {
    const bool is_there = f->where.line == device->where.line && f->where.file != NULL &&
                          device->where.file != NULL &&
                          strcmp(f->where.file, device->where.file) == 0;
    if (is_there) {
        device->where.column = f->where.column;
        device->where.length = f->where.length;
    }
}

static void find_arguments(struct dalcs_compiler *c, const struct dalcs_formula *f,
                           struct dalcs_smooth *smooth, const struct dalcs_form **argument) {
    for (int k = 0; k < smooth->n && !c->failed; k++) {
        smooth->start[k] = c->storage.is_it ? dalcs_storage_formula_at(c->builder, f->argument[k],
                                                                       c->storage.start)
                                            : 0.0;
        smooth->node[k] = smooth->source[k] = -1;
        if (dalcs_form_is_number(argument[k])) {
            smooth->number[k] = argument[k]->affine.constant;
            continue;
        }
        smooth->node[k] = plain_node(argument[k]);
        if (smooth->node[k] < 0) {
            smooth->node[k] =
                dalcs_compiler_node_at(c, "argument", f->argument[k], true, &smooth->source[k]);
        }
        c->failed = c->failed || smooth->node[k] < 0;
    }
}

static int add_smooth(struct dalcs_compiler *c, const struct dalcs_formula *f,
                      struct dalcs_smooth *smooth, const struct dalcs_form **argument) {
    struct dalcs_root root;
    const bool is_one_sided = dalcs_root_is_one_sided(c, smooth->kind, argument);
    if (is_one_sided) {
        (void)dalcs_root_begin(c, f, argument, smooth, &root);
    } else {
        find_arguments(c, f, smooth, argument);
    }
    const struct dalcs_behaviour *behaviour = c->failed ? NULL : make(c, smooth);
    const int node = behaviour != NULL ? dalcs_compiler_new_node(c, "function") : -1;
    if (node < 0 || dalcs_compiler_add_source(c, "function", node, behaviour) < 0) {
        return -1;
    }
    struct dalcs_circuit *circuit = c->builder->circuit;
    point_at(f, &circuit->device[circuit->n_devices - 1]);
    circuit->control.n_smooth++;
    return is_one_sided && !dalcs_root_finish(c, &root, node) ? -1 : node;
}

const struct dalcs_form *dalcs_smooth_form(struct dalcs_compiler *c, const struct dalcs_formula *f,
                                           enum dalcs_smooth_kind kind, int n,
                                           const struct dalcs_form **argument) {
    if (c->is_silent || c->smooth_node == NULL) {
        c->failed = true;
        return NULL;
    }
    if (c->smooth_node[f->number_of] == 0) {
        struct dalcs_smooth smooth = {.kind = kind, .n = n, .is_of_storage = c->storage.is_it};
        const int node = add_smooth(c, f, &smooth, argument);
        c->failed = c->failed || node < 0;
        c->smooth_node[f->number_of] = node > 0 ? node : 0;
    }
    const struct dalcs_affine v =
        dalcs_affine_of(c, DALCS_QUANTITY_VOLTAGE, c->smooth_node[f->number_of]);
    return c->failed ? NULL : dalcs_form_affine(c, &v);
}

int dalcs_smooth_add(struct dalcs_builder *builder, const struct dalcs_token *element,
                     const char *what, enum dalcs_smooth_kind kind, int n, const int *node_of) {
    struct dalcs_compiler c = {.builder = builder, .element = element};
    struct dalcs_smooth smooth = {.kind = kind, .n = n, .node = {-1, -1}, .source = {-1, -1}};
    for (int k = 0; k < n; k++) {
        smooth.node[k] = node_of[k];
    }
    const struct dalcs_behaviour *behaviour = make(&c, &smooth);
    struct dalcs_device *device =
        behaviour != NULL ? dalcs_builder_add_inner_device(builder, DALCS_VCVS, what, element)
                          : NULL;
    const int node = device != NULL ? dalcs_builder_inner_node(builder, what, element) : -1;
    if (node < 0) {
        return -1;
    }
    device->node[0] = node;
    device->behaviour = behaviour;
    builder->circuit->control.n_smooth++;
    return node;
}
