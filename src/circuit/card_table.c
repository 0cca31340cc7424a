/* card_table.c - the readers of the cards, and cards that are not supported.
 *
 * What other simulators know is named as such: "not supported yet", or not the business of a
 * simulator of ideal diodes. The cards inside a refused block are not looked at. Parameters, subcircuits,
 * conditions and included files are gone before: language/ has expanded them. */
#include "card_table.h"

#include "core.h"
#include "later.h"
#include "number.h"
#include "rational.h"
#include "slips.h"

#include "element_cards.h"
#include "formula.h"

#include <string.h>

struct dot_card {
    const char *name;
    enum dalcs_card_class class;
    const char *refused; /* what it is, when it is not supported yet */
    const char *hint;
    unsigned hides;        /* what a refused card may have defined */
    const char *block_end; /* the card that ends the block it starts */
};

enum {
    NOTHING = 0,
    ELEMENTS = DALCS_HIDDEN_ELEMENTS,
    MODELS = DALCS_HIDDEN_MODELS,
    ANALYSES = DALCS_HIDDEN_ANALYSES,
    ALL = DALCS_HIDDEN_ALL
};

static const struct dot_card DOT_CARDS[] = {
    {".model", DALCS_CARD_MODEL, NULL, NULL, NOTHING, NULL},
    {".tran", DALCS_CARD_TRAN, NULL, NULL, NOTHING, NULL},
    {".pss", DALCS_CARD_PSS, NULL, NULL, NOTHING, NULL},
    {".env", DALCS_CARD_ENV, NULL, NULL, NOTHING, NULL},
    {".op", DALCS_CARD_OP, NULL, NULL, NOTHING, NULL},
    {".dc", DALCS_CARD_DC, NULL, NULL, NOTHING, NULL},
    {".ac", DALCS_CARD_AC, NULL, NULL, NOTHING, NULL},
    {".sens", DALCS_CARD_SENS, NULL, NULL, NOTHING, NULL},
    {".step", DALCS_CARD_STEP, NULL, NULL, NOTHING, NULL},
    {".mc", DALCS_CARD_MC, NULL, NULL, NOTHING, NULL},
    {".wcase", DALCS_CARD_WORST_CASE, NULL, NULL, NOTHING, NULL},
    {".wc", DALCS_CARD_WORST_CASE, NULL, NULL, NOTHING, NULL},
    {".nodeset", DALCS_CARD_NODESET, NULL, NULL, NOTHING, NULL},
    {".control", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},
    {".endc", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},
    {".options", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".option", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".temp", DALCS_CARD_TEMPERATURE, NULL, NULL, NOTHING, NULL},
    {".opt", DALCS_CARD_OPTIONS, NULL, NULL, NOTHING, NULL},
    {".ic", DALCS_CARD_IC, NULL, NULL, NOTHING, NULL},
    {".save", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".print", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".plot", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe64", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".probe/csdf", DALCS_CARD_SIGNALS, NULL, NULL, NOTHING, NULL},
    {".meas", DALCS_CARD_MEASURE, NULL, NULL, NOTHING, NULL},
    {".measure", DALCS_CARD_MEASURE, NULL, NULL, NOTHING, NULL},
    {".four", DALCS_CARD_FOURIER, NULL, NULL, NOTHING, NULL},
    {".fourier", DALCS_CARD_FOURIER, NULL, NULL, NOTHING, NULL},
    {".losses", DALCS_CARD_LOSSES, NULL, NULL, NOTHING, NULL},
    {".switchloss", DALCS_CARD_SWITCHLOSS, NULL, NULL, NOTHING, NULL},
    {".backanno", DALCS_CARD_NONE, NULL, NULL, NOTHING, NULL},

    {".data", DALCS_CARD_NONE, "tables of parameters",
     "write .step param name list value value ...", NOTHING, ".enddata"},
    {".enddata", DALCS_CARD_NONE, "tables of parameters", NULL, NOTHING, NULL},
    {".distribution", DALCS_CARD_NONE, "distributions by tables",
     "write table(rand(), 0, smallest, ..., 1, largest) in a .param", NOTHING, NULL},
    {".sampling", DALCS_CARD_NONE, "Xyce's samplings",
     "write agauss, aunif, ... in expressions, and .mc with the number of runs", NOTHING, NULL},
    {".embeddedsampling", DALCS_CARD_NONE, "Xyce's samplings",
     "write agauss, aunif, ... in expressions, and .mc with the number of runs", NOTHING, NULL},
    {".machine", DALCS_CARD_NONE, "state machines",
     "A elements with SRFLOP, DFLOP or COUNTER are flip-flops and counters", ELEMENTS,
     ".endmachine"},
    {".endmachine", DALCS_CARD_NONE, "state machines", NULL, NOTHING, NULL},
    {".alter", DALCS_CARD_NONE, "altered runs", "write .step, or alter in a .control block",
     NOTHING, NULL},
};

/* Without a meaning for ideal elements; accepted. */
static const char *const IGNORED[] = {".width",  ".prot", ".unprot", ".preprocess",
                                      ".stmlib", ".list", ".status"};

/* What is computed from an .ac besides its signals. */
static const char NETWORK_PARAMETERS[] = ".net";

/* LTspice's sound files, an output beside others. */
static const char SOUND[] = ".wave";

/* LTspice's file of a bias point: one that the run writes, or takes first guesses from. */
static const char *const BIAS[] = {".savebias", ".loadbias"};

/* Xyce's values of formulas at the end of each step. */
static const char RESULT[] = ".result";

/* Analyses that this simulator will not have. */
static const char *const NEVER[] = {".noise", ".pz", ".disto", ".tf",
                                    ".sp",    ".hb", ".stab",  ".ferret"};

/* Elements by letter that are not supported. */
static const char *refused_element(char letter) {
    switch (letter) {
    case 'j':
        return "transistors";
    case 'n':
        return "compiled models";
    case 'o':
    case 'u':
    case 'y':
    case 'p':
        return "transmission lines with losses";
    default:
        return NULL;
    }
}

static const char *hint_of_element(char letter) {
    switch (letter) {
    case 'j':
        return "write an ideal switch S, with a diode D across it for a body diode";
    case 'o':
    case 'u':
    case 'y':
    case 'p':
        return "Tname a b c d Z0=ohms TD=seconds is a line without losses";
    default:
        return NULL;
    }
}

static const char CARDS[] =
    "the cards are: .model .ic .tran .op .dc .ac .step .options .save .print .end";

static void report_unknown(struct dalcs_builder *builder, const struct dalcs_token *name) {
    const char *names[sizeof DOT_CARDS / sizeof DOT_CARDS[0]];
    const size_t n = sizeof DOT_CARDS / sizeof DOT_CARDS[0];
    for (size_t k = 0; k < n; k++) {
        names[k] = DOT_CARDS[k].name;
    }
    dalcs_builder_error(builder, name,
                        dalcs_builder_suggest_of(builder, names, n, name->text, CARDS),
                        "unknown card '%s'", name->text);
}

/* Formulas on a card that names signals: each may become a source. */
static size_t count_formulas(const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 1; k < card->n; k++) {
        n += card->token[k].kind == DALCS_TOKEN_FORMULA ? 1 : 0;
    }
    return n;
}

static enum dalcs_card_class classify_dot(struct dalcs_card_table *table,
                                          const struct dalcs_token *name) {
    struct dalcs_builder *builder = table->builder;
    for (size_t k = 0; k < sizeof DOT_CARDS / sizeof DOT_CARDS[0]; k++) {
        const struct dot_card *card = &DOT_CARDS[k];
        if (strcmp(card->name, name->text) != 0) {
            continue;
        }
        if (card->refused != NULL) {
            dalcs_builder_error(builder, name, card->hint, "%s are not supported yet (%s)",
                                card->refused, card->name);
            builder->hidden |= card->hides;
            table->block_begin = card->name;
            table->block_end = card->block_end;
            table->block_depth = card->block_end != NULL;
        }
        return card->class;
    }
    if (dalcs_builder_is_one_of(name->text, IGNORED, sizeof IGNORED / sizeof IGNORED[0])) {
        dalcs_builder_note(builder, name, NULL, "%s has no meaning here and is ignored",
                           name->text);
    } else if (strcmp(name->text, NETWORK_PARAMETERS) == 0) {
        dalcs_builder_warn(builder, name, "v(out)/i(v1) of an .ac is an impedance",
                           "network parameters (.net) are not computed: the card is left out");
    } else if (strcmp(name->text, SOUND) == 0) {
        dalcs_builder_warn(builder, name, "-o file.csv has the waveforms",
                           "sound files (.wave) are not written: the card is left out");
    } else if (dalcs_builder_is_one_of(name->text, BIAS, sizeof BIAS / sizeof BIAS[0])) {
        dalcs_builder_warn(builder, name, ".ic v(node)=volts sets where a run begins",
                           "files of bias points (%s) are not used: the card is left out",
                           name->text);
    } else if (strcmp(name->text, RESULT) == 0) {
        dalcs_builder_warn(builder, name, ".meas tran name FIND formula AT=time is one",
                           "no file of results (.result) is written: the card is left out");
    } else if (dalcs_builder_is_one_of(name->text, NEVER, sizeof NEVER / sizeof NEVER[0])) {
        dalcs_builder_error(builder, name, "use .tran, .op, .dc or .ac",
                            "%s is not an analysis of ideal-diode circuits", name->text);
        builder->hidden |= DALCS_HIDDEN_ANALYSES;
    } else {
        report_unknown(builder, name);
        builder->hidden |= DALCS_HIDDEN_ALL;
    }
    return DALCS_CARD_NONE;
}

/* Each becomes a device, and one more measures their current. */
static size_t count_parasitics(const struct dalcs_card *card) {
    size_t n = 0;
    for (int k = 2; k < card->n; k++) {
        n += card->token[k].kind == DALCS_TOKEN_EQUAL &&
             dalcs_parasitic_is_name(card->token[k - 1].text);
    }
    return n > 0 ? n + 1 : 0;
}

/* A flux or a charge that is no straight line: terminal, core, and what finds the argument. */
static size_t count_storage(const struct dalcs_card *card) {
    const bool is_storage = card->letter == 'l' || card->letter == 'c';
    const size_t n_core = dalcs_core_count(card);
    return is_storage ? 3 * count_formulas(card) + (n_core > 0 ? 3 + n_core : 0) : 0;
}

/* I1 a b 50m load */
static bool is_load(const struct dalcs_card *card) {
    bool found = false;
    for (int k = 3; k < card->n && card->letter == 'i'; k++) {
        found = found || (card->token[k].kind == DALCS_TOKEN_WORD &&
                          strcmp(card->token[k].text, "load") == 0);
    }
    return found;
}

static bool is_transfer(const struct dalcs_card *card) {
    bool is = false;
    for (int k = 3; k < card->n; k++) {
        is = is || strcmp(card->token[k].text, "laplace") == 0;
    }
    return is;
}

/* A triac becomes 6 devices, of a code model each port is a gate at most, with an input. */
static void count_block(struct dalcs_card_table *table, const struct dalcs_card *card) {
    if (card->letter == 'a') {
        const size_t n = (size_t)card->n;
        table->n_inner += 6 + 5 * n;
        table->n_stimuli += 2 * n;
        table->n_gates += n;
        table->n_gate_inputs += n;
    }
}

static enum dalcs_card_class classify_element(struct dalcs_card_table *table,
                                              const struct dalcs_card *card) {
    struct dalcs_builder *builder = table->builder;
    const struct dalcs_token *name = card->token;
    const char letter = card->letter;
    if (dalcs_slip_lacks_dot(card)) {
        builder->hidden |= DALCS_HIDDEN_ALL;
        dalcs_builder_error(builder, name,
                            dalcs_builder_hint(builder, "did you mean '.%s'?", name->text),
                            "'%s' lacks the '.' of a card", name->text);
        return DALCS_CARD_NONE;
    }
    if (letter == 'k') {
        const size_t n_coils = (size_t)dalcs_coupling_count_coils(card);
        table->n_pairs += n_coils * (n_coils - 1) / 2;
        return DALCS_CARD_COUPLING;
    }
    if (strchr("rlcviefghdswabmzqt", letter) != NULL) {
        table->n_stimuli += strchr("vic", letter) != NULL;
        if (letter == 'v') {
            const size_t n_limits = (size_t)dalcs_current_limit_count(card);
            table->n_inner += 2 * n_limits;
            table->n_stimuli += n_limits;
        }
        table->n_inner += count_parasitics(card) + count_storage(card);
        const size_t n_delays = dalcs_delay_count(builder, card);
        table->n_inner += n_delays * DALCS_GATE_DEVICES;
        table->n_stimuli += 2 * n_delays;
        table->n_gates += n_delays;
        table->n_gate_inputs += n_delays;
        table->n_stimuli += dalcs_core_count(card);
        if (letter == 't') {
            table->n_inner += DALCS_LINE_DEVICES;
            table->n_stimuli += 2;
        }
        table->n_inner += is_load(card) ? 2 : 0;
        if (dalcs_card_is_logic(card)) {
            table->n_gates++;
            table->n_gate_inputs += DALCS_GATE_PINS;
            table->n_stimuli += 10; /* of a modulator with two outputs */
            table->n_inner += DALCS_GATE_DEVICES;
            if (strcmp(card->token[DALCS_LOGIC_MODEL].text, "phasedet") == 0) { /* three gates */
                table->n_gates += 2;
                table->n_gate_inputs += DALCS_GATE_PINS;
                table->n_inner += 2 * DALCS_GATE_DEVICES;
            }
        } else {
            count_block(table, card);
        }
        table->n_inner += letter == 'l' &&
                          dalcs_dialect_is_told(builder->netlist->dialect, DALCS_DIALECT_LTSPICE);
        if (strchr("efgh", letter) != NULL) {
            const size_t n = dalcs_poly_count(card);
            table->n_inner += n;
            table->n_stimuli += n > 0;
            table->n_inner += is_transfer(card) ? 2 * DALCS_RATIONAL_DEGREE + 1 : 0;
        }
        table->n_inner += letter == 'b' && is_transfer(card) ? 2 * DALCS_RATIONAL_DEGREE + 1 : 0;
        table->n_inner += letter == 's' && dalcs_formula_find_control(card) < card->n;
        table->n_switches += letter == 's' || letter == 'w';
        table->n_diodes += letter == 'd' || letter == 'a';
        if (strchr("mzq", letter) !=
            NULL) { /* terminal, diode, knee; two have lines of their own */
            table->n_inner += 3;
            table->n_scaled += 2;
            table->n_diodes++;
        }
        table->n_scaled += letter == 'd' && (card->n > 4 || card->parallel > 0);
        table->n_scaled += letter == 'a' ? 2 : 0; /* the limits of an integrator */
        return DALCS_CARD_ELEMENT;
    }
    const char *what = refused_element(letter);
    builder->hidden |= DALCS_HIDDEN_ELEMENTS;
    if (what != NULL) {
        dalcs_builder_error(builder, name, hint_of_element(letter),
                            "%s are not supported yet ('%s')", what, name->text);
    } else {
        dalcs_builder_error(builder, name, "'*' starts a comment line, '+' continues a card",
                            "'%s' is neither an element nor a card that starts with '.'",
                            name->text);
    }
    return DALCS_CARD_NONE;
}

/* Does a model name either of these parameters? */
static bool is_model_with(const struct dalcs_card *card, const char *one, const char *other) {
    bool found = false;
    for (int k = 1; k < card->n && strcmp(card->token->text, ".model") == 0; k++) {
        found = found || strcmp(card->token[k].text, one) == 0 ||
                strcmp(card->token[k].text, other) == 0;
    }
    return found;
}

void dalcs_card_table_make_room(struct dalcs_card_table *table) {
    if (table->has_series) {
        table->n_inner += 2 * table->n_switches;
        table->n_stimuli += table->n_switches;
    }
    if (table->has_limits) {
        table->n_inner += 4 * (table->n_diodes + table->n_switches);
        table->n_stimuli += 2 * (table->n_diodes + table->n_switches);
    }
}

enum dalcs_card_class dalcs_card_table_classify(struct dalcs_card_table *table,
                                                const struct dalcs_card *card) {
    const struct dalcs_token *name = card->token;
    if (name->kind != DALCS_TOKEN_WORD) {
        if (table->block_end == NULL && name->kind != DALCS_TOKEN_BAD) {
            dalcs_builder_error(table->builder, name, NULL, "a card cannot start with '%s'",
                                name->text);
        }
        table->builder->hidden |= DALCS_HIDDEN_ALL;
        return DALCS_CARD_NONE;
    }
    if (table->block_end != NULL) {
        table->block_depth += strcmp(name->text, table->block_begin) == 0;
        table->block_depth -= strcmp(name->text, table->block_end) == 0;
        if (table->block_depth == 0) {
            table->block_end = NULL;
        }
        return DALCS_CARD_NONE;
    }
    table->has_series = table->has_series || is_model_with(card, "lser", "vser");
    table->has_limits = table->has_limits || is_model_with(card, "ilimit", "revilimit");
    table->n_inner += card->letter == '.' ? count_formulas(card) : 0;
    return card->letter == '.' ? classify_dot(table, name) : classify_element(table, card);
}
