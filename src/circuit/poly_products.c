/* poly_products.c - the products of controls in a POLY, each a product of one of lower order and a control.
 *
 * SPICE2's order of the terms is that of words over the controls: c1 c1, c1 c2, ..., c2 c2, ...; then c1 c1 c1, ... So a
 * product without its last factor is a product, or a control, that came before. */
#include "behaviour.h"
#include "poly.h"

struct product {
    int shorter; /* the product without the last factor; 0: none */
    int last;    /* control */
    int node;    /* at its value; 0: not made so far */
};

/* A source to ground that puts out a control at a node; -1 after an error. */
static int control_node(const struct poly *p, int k) {
    struct dalcs_builder *builder = p->reader->builder;
    const bool by_voltage = p->device->kind == DALCS_VCVS || p->device->kind == DALCS_VCCS;
    if (by_voltage && p->node[2 * k + 1] == 0) {
        return p->node[2 * k];
    }
    const char *what = dalcs_builder_hint(builder, "c%d", k + 1);
    struct dalcs_device *source =
        what == NULL ? NULL
                     : dalcs_builder_add_inner_device(builder, by_voltage ? DALCS_VCVS : DALCS_CCVS,
                                                      what, p->reader->card->token);
    if (source == NULL) {
        return -1;
    }
    source->value = 1.0;
    source->node[0] = dalcs_builder_inner_node(builder, what, p->reader->card->token);
    if (by_voltage) {
        source->node[2] = p->node[2 * k];
        source->node[3] = p->node[2 * k + 1];
    } else {
        builder->elements.control_token[source - builder->circuit->device] = p->source[k];
    }
    return source->node[0];
}

/* The node of product k, made with those that it is made of. */
static int node_of(const struct poly *p, struct product *product, int k) {
    struct product *of = &product[k];
    if (of->node != 0) {
        return of->node;
    }
    if (of->shorter == 0) {
        of->node = control_node(p, of->last);
        return of->node;
    }
    const int first = node_of(p, product, of->shorter);
    const int second = node_of(p, product, 1 + of->last);
    const char *what = dalcs_builder_hint(p->reader->builder, "product%d", k);
    of->node = first > 0 && second > 0 && what != NULL
                   ? dalcs_smooth_add(p->reader->builder, p->reader->card->token, what,
                                      DALCS_SMOOTH_PRODUCT, 2, (int[]){first, second})
                   : -1;
    return of->node;
}

/* product[n_coefficients], the constant and the controls first. */
static void list(const struct poly *p, struct product *product) {
    int n = 1;
    for (; n <= p->n && n < p->n_coefficients; n++) {
        product[n] = (struct product){.last = n - 1};
    }
    for (int from = 1; n < p->n_coefficients; from++) {
        for (int c = product[from].last; c < p->n && n < p->n_coefficients; c++) {
            product[n++] = (struct product){.shorter = from, .last = c};
        }
    }
}

bool dalcs_poly_add_products(const struct poly *p, bool in_series) {
    struct dalcs_builder *builder = p->reader->builder;
    const struct dalcs_token *name = p->reader->card->token;
    if (p->n_coefficients <= p->n + 1) {
        return true;
    }
    struct product *product =
        dalcs_arena_alloc(&builder->scratch, (size_t)p->n_coefficients, sizeof *product);
    if (product == NULL) {
        builder->out_of_memory = true;
        return false;
    }
    list(p, product);
    for (int k = p->n + 1; k < p->n_coefficients; k++) {
        if (p->coefficient[k] == 0) {
            continue;
        }
        const int node = node_of(p, product, k);
        const char *what = dalcs_builder_hint(builder, "p%d", k);
        struct dalcs_device *part =
            node > 0 && what != NULL ? dalcs_builder_add_inner_device(
                                           builder, in_series ? DALCS_VCVS : DALCS_VCCS, what, name)
                                     : NULL;
        if (!dalcs_poly_place(p, part, what, in_series)) {
            return false;
        }
        part->value = p->coefficient[k];
        part->node[2] = node;
    }
    return true;
}
