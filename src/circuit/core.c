/* core.c - a coil on a core with hysteresis: Hc, Bs, Br, A, Lm, Lg, N on a coil's card (J. H. Chan, A. Vladimirescu,
 * X.-C. Gao, P. Liebmann, J. Valainis, IEEE Trans. CAD 10, 1991).
 *
 * Its two branches B = Bs (H +- Hc)/(|H +- Hc| + c) + mu0 H, c = Hc (Bs/Br - 1), are one curve moved by Hc either way.
 * The curve becomes straight lines between points at which sqrt(1 - u), u = |H|/(|H| + c), is in equal steps: then each
 * is off by the same Bs/n^2 at most. What moves it is a coil in parallel whose current is limited to that of Hc, by
 * ideal diodes: a stop of Prandtl and Ishlinskii, which is a complementarity and can only dissipate. Its inductance
 * lets it turn over within Bs - Br, on the way from saturation to remanence, so that coercivity and remanence of the
 * major loop are the card's. The initial permeability is Chan's over 1 + (Br/Bs)^2; minor loops are those of the stop
 * (Madelung's rules), where Chan's are moved branches. */
#include "core.h"

#include "element_cards.h"
#include "quantity.h"
#include "reader.h"

#include <math.h>
#include <string.h>

enum { HC, BS, BR, AREA, LM, LG, TURNS, SEGMENTS };

static const struct {
    const char *name, *unit;
} PARAMETERS[DALCS_CORE_PARAMETERS] = {
    [HC] = {"hc", "A/m"},     [BS] = {"bs", "T"},
    [BR] = {"br", "T"},       [AREA] = {"a", "m^2"},
    [LM] = {"lm", "m"},       [LG] = {"lg", "m"},
    [TURNS] = {"n", "turns"}, [SEGMENTS] = {"segments", "lines"}};

static const char USAGE[] = "a core is: Lname node node Hc= Bs= Br= A= Lm= [Lg=] N= [segments=10]";

static const double MU0 = 1.25663706212e-6; /* H/m */

/* Lines on each side of 0, if not told: off by Bs/100. */
enum { DEFAULT_SEGMENTS = 10, MOST_SEGMENTS = 100 };

/* A coil, and for each of two limits a source and a diode. */
enum { STOP_DEVICES = 5, STOP_STIMULI = 2 };

static int index_of(const char *name) {
    int k = 0;
    while (k < DALCS_CORE_PARAMETERS && strcmp(PARAMETERS[k].name, name) != 0) {
        k++;
    }
    return k;
}

bool dalcs_core_is_name(const char *name) {
    return index_of(name) < DALCS_CORE_PARAMETERS;
}

bool dalcs_core_read(struct dalcs_reader *reader, const struct dalcs_token *name,
                     struct dalcs_core *core) {
    const int k = index_of(name->text);
    if (core->place[k] != NULL) {
        dalcs_builder_error(reader->builder, name, NULL, "'%s' is given twice", name->text);
        return false;
    }
    core->place[k] = name;
    core->first = core->first != NULL ? core->first : name;
    return dalcs_reader_number(reader, DALCS_PLAIN, "a number", &core->value[k]);
}

/* False when an error was reported. */
static bool check(struct dalcs_builder *builder, const struct dalcs_core *core) {
    for (int k = 0; k < DALCS_CORE_PARAMETERS; k++) {
        const bool may_miss = k == LG || k == SEGMENTS;
        if (core->place[k] == NULL && !may_miss) {
            dalcs_builder_error(builder, core->first, USAGE, "a core has no '%s=' (%s)",
                                PARAMETERS[k].name, PARAMETERS[k].unit);
            return false;
        }
        if (core->place[k] != NULL && !(core->value[k] > 0 || (k == LG && core->value[k] == 0))) {
            dalcs_builder_error(builder, core->place[k], NULL, "'%s' must be positive",
                                PARAMETERS[k].name);
            return false;
        }
    }
    const double n = core->value[SEGMENTS];
    if (core->place[SEGMENTS] != NULL && (n != rint(n) || n < 2 || n > MOST_SEGMENTS)) {
        dalcs_builder_error(builder, core->place[SEGMENTS], NULL,
                            "'segments' is a whole number from 2 to %d", MOST_SEGMENTS);
        return false;
    }
    if (core->value[BR] >= core->value[BS]) {
        dalcs_builder_error(builder, core->place[BR], NULL,
                            "the remanence 'br' must be below the saturation 'bs'");
        return false;
    }
    return true;
}

/* The point of the curve with a given u: A and Wb. */
static void point_at(const struct dalcs_core *core, double u, double m, double *ampere,
                     double *weber) {
    const double *p = core->value;
    const double h = p[HC] * (p[BS] / p[BR] - 1) * u / (1 - u);
    const double b = p[BS] * u + MU0 * h;
    *ampere = m * (h * p[LM] + b / MU0 * p[LG]) / p[TURNS];
    *weber = p[TURNS] * p[AREA] * b;
}

static bool make_curve(struct dalcs_builder *builder, const struct dalcs_core *core, int n,
                       double m, struct dalcs_piecewise *curve) {
    const double *p = core->value;
    struct dalcs_knot *knot =
        dalcs_arena_alloc(&builder->scratch, (size_t)(2 * (n - 1)), sizeof *knot);
    for (int k = 1; knot != NULL && k < n; k++) {
        const double root = 1 - (double)k / n;
        double i;
        double flux;
        point_at(core, 1 - root * root, m, &i, &flux);
        knot[n - 1 + k - 1] = (struct dalcs_knot){i, flux, flux, flux};
        knot[n - 1 - k] = (struct dalcs_knot){-i, -flux, -flux, -flux};
    }
    const double slope = p[TURNS] * p[TURNS] * p[AREA] * MU0 / (m * (p[LM] + p[LG]));
    *curve =
        (struct dalcs_piecewise){.n = 2 * (n - 1), .knot = knot, .before = slope, .after = slope};
    builder->out_of_memory = builder->out_of_memory || knot == NULL;
    return knot != NULL;
}

static void tell(struct dalcs_builder *builder, const struct dalcs_card *card,
                 const struct dalcs_core *core, int n, const struct dalcs_core_stop *stop) {
    const double *p = core->value;
    const double ratio = p[BR] / p[BS];
    char off[DALCS_QUANTITY_SIZE];
    char ampere[DALCS_QUANTITY_SIZE];
    dalcs_builder_note(
        builder, core->first, NULL,
        "'%s': the core's curve is %d straight lines, off by %s at most, and its hysteresis a "
        "current of %s either way; coercivity and remanence are the card's, the initial "
        "permeability is %.3g, %.2g %% below Chan's, and minor loops are not moved",
        card->token->text, 2 * n - 1, dalcs_quantity_write(off, p[BS] / (n * n), "T", 2),
        dalcs_quantity_write(ampere, stop->ampere, "A", 3),
        ratio * (p[BS] - p[BR]) / (p[HC] * (1 + ratio * ratio)) / MU0 + 1,
        100 * ratio * ratio / (1 + ratio * ratio));
}

bool dalcs_core_make(struct dalcs_builder *builder, const struct dalcs_card *card,
                     const struct dalcs_core *core, double m, struct dalcs_storage_law *law,
                     struct dalcs_core_stop *stop) {
    const double *p = core->value;
    if (!check(builder, core)) {
        return false;
    }
    const int n = core->place[SEGMENTS] != NULL ? (int)p[SEGMENTS] : DEFAULT_SEGMENTS;
    *law = (struct dalcs_storage_law){.is_curve = true};
    stop->ampere = m * p[HC] * p[LM] / p[TURNS];
    stop->henry = p[TURNS] * p[AREA] * (p[BS] - p[BR]) / 2 / stop->ampere;
    tell(builder, card, core, n, stop);
    return make_curve(builder, core, n, m, &law->curve);
}

void dalcs_core_add_stop(struct dalcs_builder *builder, const struct dalcs_token *element,
                         const int *node, const struct dalcs_core_stop *stop) {
    struct dalcs_device *coil =
        dalcs_builder_add_inner_device(builder, DALCS_INDUCTOR, "loss", element);
    const struct dalcs_current_limits limits = {.forward = stop->ampere, .reverse = stop->ampere};
    if (coil != NULL) {
        coil->node[0] = node[0];
        coil->node[1] = node[1];
        coil->value = stop->henry;
        dalcs_current_limit_expand(builder, element, coil, &limits);
    }
}

size_t dalcs_core_count(const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 4; k < card->n && card->letter == 'l'; k++) {
        const bool is_one =
            card->token[k].kind == DALCS_TOKEN_EQUAL && strcmp(card->token[k - 1].text, "hc") == 0;
        n = is_one ? STOP_DEVICES : n;
    }
    return n;
}
