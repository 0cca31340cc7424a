/* transistor.c - M, Z and Q elements: MOSFETs, IGBTs and bipolar transistors as switches.
 *
 *     MOSFET    a switch between drain and source that v(gate, source) commands, and a body diode across it; where
 *               the bulk is elsewhere a channel of two ends that are alike (channel.c), and a diode from there to each
 *     IGBT      a diode with the knee Vce0 in series with a switch, and a diode across both where the card has one
 *     bipolar   a switch between collector and emitter, and a diode from base to emitter: only with .options bjt=switch
 *
 * A short before the drain measures what switch and diode carry together. How large the resistance is depends on the
 * gate's drive: transistor_drive.c, when all elements are known. */
#include "transistor.h"

#include "element_cards.h"
#include "language.h"
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

static const char MOSFET_USAGE[] =
    "a MOSFET is: Mname drain gate source [bulk] model [W=m L=m M=count]";
static const char IGBT_USAGE[] = "an IGBT is: Zname collector gate emitter model [M=count]";
static const char BIPOLAR_USAGE[] =
    "a bipolar transistor is: Qname collector base emitter [substrate] model [M=count]";

/* ---- The model --------------------------------------------------------------------------------------- */

static const char *usage_of(char letter) {
    return letter == 'm' ? MOSFET_USAGE : letter == 'z' ? IGBT_USAGE : BIPOLAR_USAGE;
}

/* A model that nothing defines: from the table of transistors or, where a library is not here that may have it, a
 * typical one. NULL: neither. */
static struct dalcs_transistor *take_part(struct dalcs_builder *builder,
                                          const struct dalcs_token *name) {
    struct dalcs_transistor *t = dalcs_arena_alloc(&builder->scratch, 1, sizeof *t);
    if (t == NULL) {
        builder->out_of_memory = true;
        return NULL;
    }
    *t = (struct dalcs_transistor){.kind = DALCS_MOSFET,
                                   .name = name->text,
                                   .width = 1,
                                   .length = 1,
                                   .leakage = (double)INFINITY,
                                   .has_diode = true,
                                   .diode = {.saturation = 1e-14,
                                             .emission = 1,
                                             .breakdown = (double)INFINITY,
                                             .breakdown_current = 1}};
    const bool is_listed = dalcs_transistor_part_find(name->text, t);
    if (builder->models.n >= builder->models.capacity ||
        (!is_listed && builder->netlist->missing_library == NULL)) {
        return NULL;
    }
    builder->models.model[builder->models.n] = (struct dalcs_model){
        .kind = DALCS_MODEL_TRANSISTOR, .name = name, .type = name, .transistor = t};
    if (dalcs_names_add(&builder->models.names, name->text, builder->models.n) != DALCS_OK) {
        builder->out_of_memory = true;
        return NULL;
    }
    builder->models.n++;
    if (is_listed) {
        dalcs_builder_warn(
            builder, name,
            dalcs_builder_hint(builder, "add a line: .model %s VDMOS(Vto=... Ron=...)", name->text),
            "model '%s' is not in the netlist: typical datasheet values are used", name->text);
    } else {
        dalcs_transistor_make_typical(t, name);
    }
    return t;
}

static void report_missing(struct dalcs_builder *builder, const struct dalcs_token *name,
                           char letter) {
    builder->failed = true;
    if ((builder->hidden & DALCS_HIDDEN_MODELS) != 0) {
        return;
    }
    const char *type = letter == 'm'   ? "NMOS(Vto=3 Ron=50m)"
                       : letter == 'z' ? "NIGBT(Vt=5 Vce0=1 Ron=20m)"
                                       : "NPN";
    dalcs_builder_error(builder, name,
                        dalcs_builder_hint(builder, "add a line: .model %s %s", name->text, type),
                        "there is no model '%s'", name->text);
}

/* NULL when an error was reported. */
static struct dalcs_transistor *find_model(struct dalcs_builder *builder,
                                           const struct dalcs_token *name, char letter) {
    const int index = dalcs_names_find(&builder->models.names, name->text);
    if (index < 0) {
        struct dalcs_transistor *part = letter == 'm' ? take_part(builder, name) : NULL;
        if (part == NULL && !builder->out_of_memory) {
            report_missing(builder, name, letter);
        }
        return part;
    }
    struct dalcs_model *model = &builder->models.model[index];
    const enum dalcs_transistor_kind wanted = letter == 'm'   ? DALCS_MOSFET
                                              : letter == 'z' ? DALCS_IGBT
                                                              : DALCS_BIPOLAR;
    if (model->kind == DALCS_MODEL_WRONG) {
        return NULL;
    }
    if (model->kind == DALCS_MODEL_TRANSISTOR && model->transistor->kind == wanted) {
        return model->transistor;
    }
    model->was_refused = true;
    const bool is_mesfet = letter == 'z' && (strcmp(model->type->text, "nmf") == 0 ||
                                             strcmp(model->type->text, "pmf") == 0);
    if (is_mesfet) {
        dalcs_builder_error(builder, name, IGBT_USAGE,
                            "model '%s' is of a MESFET, an amplifier for microwaves: no switch",
                            name->text);
        return NULL;
    }
    dalcs_builder_error(builder, name, usage_of(letter),
                        "model '%s' is of type %s, here %s is wanted", name->text,
                        model->type->text,
                        letter == 'm'   ? "NMOS, PMOS or VDMOS"
                        : letter == 'z' ? "NIGBT"
                                        : "NPN or PNP");
    return NULL;
}

/* ---- The element --------------------------------------------------------------------------------------- */

/* Behind the model; false when an error was reported. */
static bool read_rest(struct dalcs_reader *reader, struct dalcs_transistor_use *use) {
    static const char *const nothing[] = {"ad",  "as",   "pd",    "ps",   "nrd", "nrs",
                                          "nrg", "temp", "dtemp", "area", "ic"};
    struct dalcs_builder *builder = reader->builder;
    const struct dalcs_token *next = dalcs_reader_peek(reader, 0);
    if (next != NULL && dalcs_reader_is_number(next)) { /* the area of a bipolar one */
        reader->at++;
    }
    const struct dalcs_token *name;
    (void)dalcs_reader_take_word(reader, "off");
    while ((name = dalcs_reader_take_parameter(reader)) != NULL) {
        double *value = strcmp(name->text, "w") == 0   ? &use->width
                        : strcmp(name->text, "l") == 0 ? &use->length
                        : strcmp(name->text, "m") == 0 ? &use->parallel
                                                       : NULL;
        if (value == NULL &&
            !dalcs_builder_is_one_of(name->text, nothing, sizeof nothing / sizeof nothing[0])) {
            dalcs_builder_error(builder, name, reader->usage, "a transistor has no parameter '%s'",
                                name->text);
            return false;
        }
        if (value == NULL ? !dalcs_reader_skip_value(reader)
                          : !dalcs_reader_number(reader, DALCS_PLAIN, "a value", value)) {
            return false;
        }
        if (value != NULL && !(*value > 0)) {
            dalcs_builder_error(builder, name, reader->usage, "'%s' must be positive", name->text);
            return false;
        }
    }
    use->parallel *= dalcs_parallel_of(reader->card);
    return dalcs_reader_end(reader);
}

/* A diode of the element, whose lines are the card's. */
static bool add_diode(struct dalcs_builder *builder, struct dalcs_transistor_use *use,
                      const char *what, const int *node) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *diode =
        dalcs_builder_add_inner_device(builder, DALCS_DIODE, what, use->name);
    if (diode == NULL) {
        return false;
    }
    struct dalcs_diode_model *lines = &circuit->models.of_diode[circuit->models.n_diodes];
    lines->name = circuit->device[use->device].name;
    if (use->of->kind == DALCS_IGBT) {
        *lines = (struct dalcs_diode_model){.name = lines->name,
                                            .ron = use->of->diode.resistance / use->parallel,
                                            .roff = INFINITY,
                                            .vfwd = use->of->drop,
                                            .vrev = INFINITY};
    } else {
        /* a base has milliamperes */
        const double at = use->of->kind == DALCS_BIPOLAR ? 1e-3 : builder->models.diode_current;
        dalcs_diode_model_map(&use->of->diode, at, use->parallel, lines);
        lines->exponential = (struct dalcs_exponential){0}; /* the line stays where it is */
    }
    use->diode = diode->model = circuit->models.n_diodes++;
    use->diode_device = (int)(diode - circuit->device);
    diode->node[0] = node[0];
    diode->node[1] = node[1];
    return true;
}

/* The knee of an IGBT, before its switch. */
static bool add_knee(struct dalcs_builder *builder, const struct dalcs_transistor_use *use) {
    struct dalcs_circuit *circuit = builder->circuit;
    struct dalcs_device *device = &circuit->device[use->device];
    const int inside = dalcs_builder_inner_node(builder, "inside", use->name);
    struct dalcs_device *knee =
        dalcs_builder_add_inner_device(builder, DALCS_DIODE, "knee", use->name);
    if (inside < 0 || knee == NULL) {
        return false;
    }
    knee->node[0] = device->node[0];
    knee->node[1] = device->node[0] = inside;
    circuit->models.of_diode[circuit->models.n_diodes] = (struct dalcs_diode_model){
        .name = device->name, .roff = INFINITY, .vfwd = use->of->knee, .vrev = INFINITY};
    knee->model = circuit->models.n_diodes++;
    return true;
}

/* One more diode; its direction is that of an n channel. */
static struct dalcs_device *add_other(struct dalcs_builder *builder,
                                      const struct dalcs_transistor_use *use, const char *what,
                                      int from, int to) {
    struct dalcs_device *diode =
        dalcs_builder_add_inner_device(builder, DALCS_DIODE, what, use->name);
    if (diode != NULL) {
        diode->node[0] = use->of->is_p ? to : from;
        diode->node[1] = use->of->is_p ? from : to;
    }
    return diode;
}

/* The bulk is not on the source. The switch becomes a channel when its resistance is known. */
static bool add_bulk(struct dalcs_builder *builder, struct dalcs_transistor_use *use) {
    const struct dalcs_transistor *t = use->of;
    const int drain = builder->circuit->device[use->device].node[0];
    const int ends[2] = {t->is_p ? drain : use->bulk, t->is_p ? use->bulk : drain};
    if (use->bulk == use->drain || !t->has_diode) {
        return true;
    }
    struct dalcs_device *to_source = add_other(builder, use, "bulk", use->bulk, use->source);
    if (to_source == NULL || !add_diode(builder, use, "body", ends)) {
        return false;
    }
    to_source->model = use->diode;
    return true;
}

/* What enters the drain of the card leaves at the end that is the drain here. */
static void turn(struct dalcs_device *terminal) {
    const int outside = terminal->node[0];
    terminal->node[0] = terminal->node[1];
    terminal->node[1] = outside;
}

static bool expand(struct dalcs_builder *builder, struct dalcs_transistor_use *use) {
    struct dalcs_device *device = &builder->circuit->device[use->device];
    const struct dalcs_transistor *t = use->of;
    device->node[0] = use->drain;
    device->node[1] = device->node[3] = use->source;
    device->node[2] = use->gate;
    if (!dalcs_builder_add_terminal(builder, use->name, device)) {
        return false;
    }
    if (use->is_turned) {
        turn(&builder->circuit->device[builder->elements.current_of[use->device]]);
    }
    /* the body diode leads from source to drain, that of a base to the emitter; of a p channel and PNP the other way */
    const bool is_bipolar = t->kind == DALCS_BIPOLAR;
    const int from = is_bipolar ? use->gate : use->source;
    const int to = is_bipolar ? use->source : device->node[0];
    const int diode[2] = {t->is_p ? to : from, t->is_p ? from : to};
    const bool has_bulk = use->bulk != use->source;
    if (has_bulk ? !add_bulk(builder, use)
                 : t->has_diode && !add_diode(builder, use, is_bipolar ? "base" : "body", diode)) {
        return false;
    }
    const struct dalcs_switch_model model = {.name = device->name, .is_inverted = t->is_p};
    device->model = dalcs_switch_add_model(builder, &model);
    return device->model >= 0 && (t->kind != DALCS_IGBT || add_knee(builder, use));
}

/* Of a model that is not there nothing is known, nor of a VDMOS with a bulk on the drain. */
static bool is_bulk_right(struct dalcs_builder *builder, const struct dalcs_card *card,
                          const struct dalcs_transistor_use *use) {
    static const char hint[] = "connect it to the source: that is where a power MOSFET has it";
    const char *name = card->token->text;
    if (use->bulk == use->source) {
        return true;
    }
    if (use->of->typical != NULL || use->bulk == use->drain) {
        dalcs_builder_error(
            builder, &card->token[4], hint,
            "the bulk of '%s' is not on its source: its body diodes would be others", name);
        return false;
    }
    dalcs_builder_warn(builder, &card->token[4], hint,
                       "the bulk of '%s' is not on its source: it has a diode from there to drain "
                       "and source each, and none from source to drain",
                       name);
    return true;
}

void dalcs_transistor_parse(struct dalcs_builder *builder, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(builder, card, usage_of(card->letter));
    if (card->letter == 'q' && !builder->models.bipolar_is_switch) {
        dalcs_builder_error(builder, card->token,
                            ".options bjt=switch treats it as a switch that is saturated or off",
                            "'%s' is a bipolar transistor, which need not be a switch",
                            card->token->text);
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    const int n_nodes = dalcs_roles_count_terminals(card);
    const int most = card->letter == 'z' ? 3 : 4;
    if (n_nodes < 3 || n_nodes > most) {
        dalcs_builder_error(builder, card->token, reader.usage, "'%s' has %s nodes and a model",
                            card->token->text, most == 3 ? "3" : "3 or 4");
        builder->hidden |= DALCS_HIDDEN_ELEMENTS;
        return;
    }
    struct dalcs_device *device = dalcs_builder_add_device(builder, DALCS_SWITCH, card->token);
    const struct dalcs_token *name;
    int node[4];
    if (device == NULL || !dalcs_reader_nodes(&reader, n_nodes, node) ||
        !dalcs_reader_name(&reader, "the name of a model", &name)) {
        return;
    }
    struct dalcs_transistor *t = find_model(builder, name, card->letter);
    struct dalcs_transistor_use *use = dalcs_arena_alloc(&builder->scratch, 1, sizeof *use);
    if (t == NULL || use == NULL) {
        builder->out_of_memory = builder->out_of_memory || use == NULL;
        return;
    }
    const bool has_bulk = n_nodes == 4 && card->letter == 'm';
    const bool is_turned = has_bulk && node[3] == node[0] && t->is_lateral;
    if (is_turned) { /* both ends are alike: the one with the bulk is the source */
        node[0] = node[2];
        node[2] = node[3];
    }
    *use = (struct dalcs_transistor_use){.device = (int)(device - builder->circuit->device),
                                         .name = card->token,
                                         .of = t,
                                         .drain = node[0],
                                         .gate = node[1],
                                         .source = node[2],
                                         .bulk = has_bulk ? node[3] : node[2],
                                         .width = t->width,
                                         .length = t->length,
                                         .parallel = 1,
                                         .is_turned = is_turned,
                                         .diode = -1,
                                         .before = builder->models.last_transistor};
    if (read_rest(&reader, use) && is_bulk_right(builder, card, use) && expand(builder, use)) {
        builder->models.last_transistor = use;
    }
}
