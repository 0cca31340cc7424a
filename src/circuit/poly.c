/* poly.c - POLY on E, F, G and H: a polynomial of several controls.
 *
 *     p0 + p1 c1 + ... + pn cn + p11 c1 c1 + p12 c1 c2 + ..., c a voltage (E, G) or the current of a V source (F, H)
 *
 * Each term is a device of its own: the voltages of E and H in series, the currents of F and G side
 * by side behind a short, which is an unknown only if a signal is the sum. Products are in poly_products.c. */
#include "poly.h"
#include "element_cards.h"
#include "reader.h"

#include <string.h>

enum { MOST_CONTROLS = 1000 };

static bool is_by_voltage(const struct poly *p) {
    return p->device->kind == DALCS_VCVS || p->device->kind == DALCS_VCCS;
}

static bool read_count(struct poly *p) {
    struct dalcs_reader *reader = p->reader;
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    double n;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of controls", &n)) {
        return false;
    }
    if (!(n >= 1 && n <= MOST_CONTROLS) || n != (int)n) {
        dalcs_builder_error(reader->builder, dalcs_reader_previous(reader), NULL,
                            "a number of controls is 1, 2, 3, ... up to %d", MOST_CONTROLS);
        return false;
    }
    if (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    p->n = (int)n;
    return true;
}

static bool allocate(struct poly *p) {
    struct dalcs_builder *builder = p->reader->builder;
    const size_t n = (size_t)p->n;
    p->node = dalcs_arena_alloc(&builder->scratch, 2 * n, sizeof *p->node);
    p->source = dalcs_arena_alloc(&builder->scratch, n, sizeof *p->source);
    p->coefficient = dalcs_arena_alloc(&builder->scratch, n + 1 + (size_t)p->reader->card->n,
                                       sizeof *p->coefficient);
    const bool ok = p->node != NULL && p->source != NULL && p->coefficient != NULL;
    builder->out_of_memory = builder->out_of_memory || !ok;
    return ok;
}

static bool read_controls(struct poly *p) {
    if (is_by_voltage(p)) {
        return dalcs_reader_nodes(p->reader, 2 * p->n, p->node);
    }
    for (int k = 0; k < p->n; k++) {
        if (!dalcs_reader_name(p->reader, "the name of a voltage source", &p->source[k])) {
            return false;
        }
    }
    return true;
}

static bool read_coefficients(struct poly *p) {
    struct dalcs_reader *reader = p->reader;
    const bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    int n = 0;
    do {
        double value;
        if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a coefficient", &value)) {
            return false;
        }
        p->coefficient[n++] = value;
        p->n_coefficients = value != 0 ? n : p->n_coefficients;
    } while (!dalcs_reader_at_end(reader) && dalcs_reader_is_number(dalcs_reader_peek(reader, 0)));
    if (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE)) {
        dalcs_reader_missing(reader, "')'");
        return false;
    }
    if (p->n == 1 && n == 1) {
        dalcs_builder_warn(reader->builder, dalcs_reader_previous(reader),
                           dalcs_builder_hint(reader->builder, "write 0 %g if a factor is meant",
                                              p->coefficient[0]),
                           "the only coefficient is p0, a constant, as in ngspice; other "
                           "simulators take it for the factor p1");
    }
    return dalcs_reader_end(reader);
}

static void set_control(struct poly *p, struct dalcs_device *device, int k) {
    struct dalcs_builder *builder = p->reader->builder;
    device->value = p->coefficient[k + 1];
    if (is_by_voltage(p)) {
        device->node[2] = p->node[2 * k];
        device->node[3] = p->node[2 * k + 1];
    } else {
        builder->elements.control_token[device - builder->circuit->device] = p->source[k];
    }
}

bool dalcs_poly_place(const struct poly *p, struct dalcs_device *part, const char *what,
                      bool in_series) {
    struct dalcs_device *device = p->device;
    if (part == NULL) {
        return false;
    }
    part->node[0] = device->node[0];
    part->node[1] = device->node[1];
    if (in_series) {
        const int node = dalcs_builder_inner_node(p->reader->builder, what, p->reader->card->token);
        part->node[0] = device->node[1] = node;
        return node >= 0;
    }
    return true;
}

static bool add_parts(struct poly *p, bool in_series) {
    struct dalcs_builder *builder = p->reader->builder;
    struct dalcs_circuit *circuit = builder->circuit;
    const struct dalcs_token *name = p->reader->card->token;
    for (int k = 1; k < p->n; k++) {
        const char *what = dalcs_builder_hint(builder, "p%d", k + 1);
        if (what == NULL) {
            return false;
        }
        struct dalcs_device *part =
            dalcs_builder_add_inner_device(builder, p->device->kind, what, name);
        if (!dalcs_poly_place(p, part, what, in_series)) {
            return false;
        }
        set_control(p, part, k);
    }
    if (p->coefficient[0] == 0) {
        return true;
    }
    struct dalcs_device *constant = dalcs_builder_add_inner_device(
        builder, in_series ? DALCS_VSOURCE : DALCS_ISOURCE, "p0", name);
    if (!dalcs_poly_place(p, constant, "p0", in_series)) {
        return false;
    }
    constant->stimulus = circuit->n_stimuli++;
    circuit->stimulus[constant->stimulus] =
        (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC, .has_dc = true, .dc = p->coefficient[0]};
    return true;
}

void dalcs_poly_parse(struct dalcs_reader *reader, struct dalcs_device *device) {
    struct poly p = {.reader = reader, .device = device};
    if (!read_count(&p) || !allocate(&p) || !read_controls(&p) || !read_coefficients(&p)) {
        return;
    }
    const bool in_series = device->kind == DALCS_VCVS || device->kind == DALCS_CCVS;
    set_control(&p, device, 0);
    if (p.n == 1 && p.coefficient[0] == 0 && p.n_coefficients <= 2) {
        return;
    }
    if (in_series || dalcs_builder_add_terminal(reader->builder, reader->card->token, device)) {
        (void)(add_parts(&p, in_series) && dalcs_poly_add_products(&p, in_series));
    }
}

size_t dalcs_poly_count(const struct dalcs_card *card) {
    bool found = false;
    for (int k = 1; k < card->n; k++) {
        found = found || strcmp(card->token[k].text, "poly") == 0;
    }
    return found ? 3 * (size_t)card->n : 0; /* a control, a product and a term for each word */
}
