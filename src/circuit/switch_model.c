/* switch_model.c - .model cards of switches.
 *
 * A switch is a wire or a cut (Ron = 0, Roff infinite) unless its model says otherwise. It closes
 * when the control rises through Vt + Vh and opens when it falls through Vt - Vh. The switches of
 * PSpice and LTspice that change over smoothly do it at once here, half way. */
#include "model_cards.h"
#include "reader.h"

#include <math.h>
#include <string.h>

enum {
    RON,
    ROFF,
    THRESHOLD,
    HYSTERESIS,
    LSER,
    VSER,
    ON,
    OFF,
    HYSTERESIS_ON,
    HYSTERESIS_OFF,
    ILIMIT,
    LEVEL,
    N_PARAMETERS
};

/* The types: how their parameters are called. */
struct form {
    const char *type;
    const char *usage;
    const char *name[N_PARAMETERS];
    enum dalcs_quantity quantity; /* of the control */
    const char *unit;
    double on; /* PSpice's when left out */
};

static const struct form *form_of(const char *type) {
    static const struct form forms[] = {
        {"sw",
         "a switch model is: .model name SW [(Ron=ohms Roff=ohms Vt=volts Vh=volts)]",
         {"ron", "roff", "vt", "vh", "lser", "vser", "von", "voff", "vhon", "vhoff", "ilimit",
          "level"},
         DALCS_VOLTAGE,
         "V",
         1},
        {"csw",
         "a current switch model is: .model name CSW [(Ron=ohms Roff=ohms It=amperes Ih=amperes)]",
         {"ron", "roff", "it", "ih", "lser", "vser", "ion", "ioff", "ihon", "ihoff", "ilimit",
          "level"},
         DALCS_CURRENT,
         "A",
         1e-3},
        {"vswitch",
         "a PSpice switch model is: .model name VSWITCH [(Ron=ohms Roff=ohms Von=volts "
         "Voff=volts)]",
         {"ron", "roff", "vt", "vh", "lser", "vser", "von", "voff", "vhon", "vhoff", "ilimit",
          "level"},
         DALCS_VOLTAGE,
         "V",
         1},
        {"iswitch",
         "a PSpice current switch model is: .model name ISWITCH [(Ron=ohms Roff=ohms Ion=amperes "
         "Ioff=amperes)]",
         {"ron", "roff", "it", "ih", "lser", "vser", "ion", "ioff", "ihon", "ihoff", "ilimit",
          "level"},
         DALCS_CURRENT,
         "A",
         1e-3},
        {"switch",
         "a switch model of Xyce is: .model name SWITCH [(Ron=ohms Roff=ohms On=value Off=value)]",
         {"ron", "roff", "vt", "vh", "lser", "vser", "on", "off", "onh", "offh", "ilimit", "level"},
         DALCS_PLAIN,
         "of its control",
         1},
    };
    int k = 0;
    while (strcmp(forms[k].type, type) != 0) {
        k++;
    }
    return &forms[k];
}

static bool report_parameter(struct dalcs_reader *reader, const struct dalcs_token *name) {
    static const char *const ours[] = {"ron",  "roff",  "vt",  "vh",   "it",   "ih",
                                       "von",  "voff",  "ion", "ioff", "vhon", "vhoff",
                                       "ihon", "ihoff", "on",  "off",  "onh",  "offh"};
    static const char *const later[] = {"vton", "vtoff", "td", "oneway"};
    struct dalcs_builder *builder = reader->builder;
    if (strcmp(name->text, "epsilon") == 0) { /* of LTspice's level 2, beside Ilimit */
        dalcs_builder_note(builder, name, NULL,
                           "the corner that epsilon rounds where Ilimit begins is sharp here");
        return false;
    }
    if (dalcs_builder_is_one_of(name->text, later, sizeof later / sizeof later[0])) {
        dalcs_builder_error(builder, name, reader->usage, "'%s' of a switch is not supported yet",
                            name->text);
    } else if (dalcs_builder_is_one_of(name->text, ours, sizeof ours / sizeof ours[0])) {
        dalcs_builder_error(builder, name, reader->usage,
                            "'%s' belongs to a switch model of another type", name->text);
    } else {
        dalcs_builder_error(builder, name,
                            dalcs_builder_suggest_of(builder, ours, sizeof ours / sizeof ours[0],
                                                     name->text, reader->usage),
                            "a switch model has no parameter '%s'", name->text);
    }
    return true;
}

static bool check_resistances(struct dalcs_builder *builder, const struct dalcs_parameter *p) {
    if (p[RON].value < 0) {
        dalcs_builder_error(builder, p[RON].place, NULL, "Ron cannot be negative");
        return false;
    }
    if (p[LSER].value < 0) {
        dalcs_builder_error(builder, p[LSER].place, NULL, "Lser cannot be negative");
        return false;
    }
    if (p[ILIMIT].value <= 0) {
        dalcs_builder_error(builder, p[ILIMIT].place, "leave it out for none",
                            "Ilimit must be positive");
        return false;
    }
    if (p[ROFF].value <= 0) {
        dalcs_builder_error(builder, p[ROFF].place,
                            "leave Roff out for a switch that is open when off",
                            "Roff must be positive");
        return false;
    }
    if (p[ROFF].value == p[RON].value) {
        dalcs_builder_error(builder, p[ROFF].place, "write a resistor",
                            "Roff and Ron are equal: this switches nothing");
        return false;
    }
    return true;
}

/* A switch whose Ron is the larger one is closed when it is off. */
static void exchange(struct dalcs_builder *builder, const struct dalcs_token *place,
                     struct dalcs_switch_model *model) {
    const double ron = model->roff;
    model->roff = model->ron;
    model->ron = ron;
    model->vt = -model->vt;
    model->is_inverted = !model->is_inverted;
    model->is_exchanged = true;
    dalcs_builder_warn(
        builder, place, NULL,
        "Roff is below Ron: this switch is closed, with %g ohm, where its control is "
        "low, and open, with %g ohm, where it is high",
        model->ron, model->roff);
}

int dalcs_switch_add_model(struct dalcs_builder *builder, const struct dalcs_switch_model *model) {
    struct dalcs_circuit *circuit = builder->circuit;
    const size_t n = (size_t)circuit->models.n_switches;
    if (n == builder->models.switch_capacity) {
        const size_t most = 2 * n + 4;
        struct dalcs_switch_model *all = dalcs_arena_alloc(&circuit->arena, most, sizeof *all);
        if (all == NULL) {
            builder->out_of_memory = true;
            return -1;
        }
        if (n > 0) {
            memcpy(all, circuit->models.of_switch, n * sizeof *all);
        }
        circuit->models.of_switch = all;
        builder->models.switch_capacity = most;
    }
    circuit->models.of_switch[n] = *model;
    return circuit->models.n_switches++;
}

/* Vt and Vh of SW and CSW. LTspice's negative Vh asks for a smooth change between Vt - |Vh| and
 * Vt + |Vh|; the meaning of ngspice's is not documented. */
static void set_threshold(struct dalcs_builder *builder, const struct form *form,
                          const struct dalcs_parameter *p, struct dalcs_switch_model *model) {
    model->vt = p[THRESHOLD].value;
    model->vh = fmax(p[HYSTERESIS].value, 0);
    if (p[HYSTERESIS].value < 0) {
        dalcs_builder_warn(builder, p[HYSTERESIS].place, NULL,
                           "a switch that changes over smoothly from %g to %g %s (LTspice): here "
                           "it does so at once, at %g %s",
                           model->vt + p[HYSTERESIS].value, model->vt - p[HYSTERESIS].value,
                           form->unit, model->vt, form->unit);
    }
}

/* The threshold half way, below which a switch closes whose control is smaller where it is on. */
static double set_middle(struct dalcs_switch_model *model, double on, double off) {
    const double middle = off + 0.5 * (on - off);
    model->is_inverted = on < off;
    model->vt = model->is_inverted ? -middle : middle;
    return middle;
}

/* Von and Voff of VSWITCH and ISWITCH, between which the logarithm of the resistance changes
 * smoothly: half way it is the mean of the two. */
static bool set_midpoint(struct dalcs_builder *builder, const struct form *form,
                         const struct dalcs_token *name, const struct dalcs_parameter *p,
                         struct dalcs_switch_model *model) {
    if (p[ON].value == p[OFF].value) {
        dalcs_builder_error(builder, p[ON].place != NULL ? p[ON].place : p[OFF].place, form->usage,
                            "the switch is on and off at the same control, %g %s", p[ON].value,
                            form->unit);
        return false;
    }
    const double middle = set_middle(model, p[ON].value, p[OFF].value);
    dalcs_builder_warn(builder, name, NULL,
                       "a switch that changes over smoothly from %g to %g %s: here it does so at "
                       "once, at %g %s",
                       p[OFF].value, p[ON].value, form->unit, middle, form->unit);
    return true;
}

/* VHON and VHOFF of PSpice: with hysteresis, hard at both. */
static bool set_hysteresis(struct dalcs_builder *builder, const struct form *form,
                           const struct dalcs_parameter *p, struct dalcs_switch_model *model) {
    const struct dalcs_parameter *on = &p[HYSTERESIS_ON];
    const struct dalcs_parameter *off = &p[HYSTERESIS_OFF];
    if (on->place == NULL || off->place == NULL) {
        dalcs_builder_error(builder, on->place != NULL ? on->place : off->place, form->usage,
                            "a switch with hysteresis has %s and %s", on->name, off->name);
        return false;
    }
    (void)set_middle(model, on->value, off->value);
    model->vh = 0.5 * fabs(on->value - off->value);
    return true;
}

/* The first of PSpice's parameters on a card of SPICE's type. */
static const struct dalcs_token *first_of(const struct dalcs_parameter *p) {
    int k = ON;
    while (k < HYSTERESIS_OFF && p[k].place == NULL) {
        k++;
    }
    return p[k].place;
}

/* The control at which it switches; what is not consistent is said. */
static bool set_control(struct dalcs_reader *reader, const struct form *form,
                        const struct dalcs_token *type, const struct dalcs_parameter *parameter,
                        struct dalcs_switch_model *model) {
    const bool has_ends = parameter[ON].place != NULL || parameter[OFF].place != NULL;
    const bool is_spice = strcmp(form->type, "sw") == 0 || strcmp(form->type, "csw") == 0;
    const bool has_hysteresis =
        parameter[HYSTERESIS_ON].place != NULL || parameter[HYSTERESIS_OFF].place != NULL;
    const struct dalcs_token *given = parameter[THRESHOLD].place != NULL
                                          ? parameter[THRESHOLD].place
                                          : parameter[HYSTERESIS].place;
    const bool has_threshold = given != NULL && (is_spice || (!has_hysteresis && !has_ends));
    const int n_kinds = (given != NULL) + has_ends + has_hysteresis;
    if (n_kinds > 1) {
        const int kept = has_threshold ? THRESHOLD : has_hysteresis ? HYSTERESIS_ON : ON;
        dalcs_builder_warn(reader->builder, given != NULL ? given : first_of(parameter),
                           form->usage,
                           "a switch model has either %s and %s or %s and %s or %s and %s: here %s "
                           "and %s count",
                           form->name[THRESHOLD], form->name[HYSTERESIS], form->name[ON],
                           form->name[OFF], form->name[HYSTERESIS_ON], form->name[HYSTERESIS_OFF],
                           form->name[kept], form->name[kept + 1]);
    } else if (is_spice && (has_ends || has_hysteresis)) {
        dalcs_builder_warn(reader->builder, first_of(parameter), form->usage,
                           "'%s' is PSpice's: this %s model is read as its %s; ngspice ignores the "
                           "parameter",
                           first_of(parameter)->text, type->text,
                           form->quantity == DALCS_VOLTAGE ? "VSWITCH" : "ISWITCH");
    }
    if (has_threshold || (n_kinds == 0 && is_spice)) {
        set_threshold(reader->builder, form, parameter, model);
        return true;
    }
    return has_hysteresis ? set_hysteresis(reader->builder, form, parameter, model)
                          : set_midpoint(reader->builder, form, type, parameter, model);
}

/* LTspice's level 2 changes over smoothly, whatever the sign of Vh. */
static bool check_level(struct dalcs_reader *reader, struct dalcs_parameter *p) {
    if (p[LEVEL].value == 2) {
        p[HYSTERESIS].value = -fabs(p[HYSTERESIS].value);
    } else if (p[LEVEL].value != 1) {
        dalcs_builder_error(reader->builder, p[LEVEL].place, reader->usage,
                            "the level of a switch is 1 or 2");
        return false;
    }
    return true;
}

bool dalcs_switch_parse_model(struct dalcs_reader *reader, const struct dalcs_token *type,
                              struct dalcs_switch_model *model) {
    const struct form *form = form_of(type->text);
    struct dalcs_parameter parameter[N_PARAMETERS] = {
        [RON] = {.quantity = DALCS_OHM},
        [ROFF] = {.quantity = DALCS_OHM, .may_be_infinite = true, .value = (double)INFINITY},
        [THRESHOLD] = {.quantity = form->quantity},
        [HYSTERESIS] = {.quantity = form->quantity},
        [ON] = {.quantity = form->quantity, .value = form->on},
        [OFF] = {.quantity = form->quantity},
        [HYSTERESIS_ON] = {.quantity = form->quantity},
        [HYSTERESIS_OFF] = {.quantity = form->quantity},
        [LSER] = {.quantity = DALCS_HENRY},
        [VSER] = {.quantity = DALCS_VOLTAGE},
        [ILIMIT] = {.quantity = DALCS_CURRENT, .may_be_infinite = true, .value = (double)INFINITY},
        [LEVEL] = {.quantity = DALCS_PLAIN, .value = 1},
    };
    for (int k = 0; k < N_PARAMETERS; k++) {
        parameter[k].name = form->name[k];
    }
    reader->usage = form->usage;
    if (!dalcs_model_read_parameters(reader, parameter, N_PARAMETERS, report_parameter)) {
        return false;
    }
    model->ron = parameter[RON].value;
    model->roff = parameter[ROFF].value;
    model->lser = parameter[LSER].value;
    model->vser = parameter[VSER].value;
    model->ilimit = parameter[ILIMIT].value;
    if (!check_resistances(reader->builder, parameter) || !check_level(reader, parameter)) {
        return false;
    }
    if (!set_control(reader, form, type, parameter, model)) {
        return false;
    }
    if (model->roff < model->ron) {
        exchange(reader->builder, parameter[ROFF].place, model);
    }
    return true;
}
