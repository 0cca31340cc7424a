/* read_system.c - a system file: cards, in the words of a netlist, to a circuit and a network.
 *
 *     dalcs-system 2 TITLE        the first line
 *     .param .func .tran .op .options    as in a netlist
 *     input NAME ...              a source function
 *     network NAME                jumps of charge and flux, held .ic: see `equations`
 *     system [NAME]               the next one; its columns and matrices follow
 *     output, element             what is recorded
 *
 * dalcs_description_read_text at the end is the table of contents. */
#include "reading.h"

#include <stdlib.h>
#include <string.h>

static const char MAGIC[] = "dalcs-system 2";
static const char JSON_MAGIC[] = "\"dalcs-system\"";

bool dalcs_description_is_text(const char *text, size_t length) {
    size_t n = sizeof MAGIC - 1;
    size_t skipped = length >= 3 && memcmp(text, "\xEF\xBB\xBF", 3) == 0 ? 3 : 0;
    const char *at = text + skipped;
    length -= skipped;
    if (length >= n && memcmp(at, MAGIC, n) == 0) {
        return length == n || strchr(" \t\r\n", at[n]) != NULL;
    }
    /* JSON: the key is the first one. */
    size_t k = 0;
    while (k < length && strchr(" \t\r\n", at[k]) != NULL && at[k] != '\0') {
        k++;
    }
    bool is_object = k < length && at[k] == '{';
    for (k++; is_object && k < length && at[k] != '\0' && strchr(" \t\r\n", at[k]) != NULL; k++) {
    }
    return is_object && length - k >= sizeof JSON_MAGIC - 1 &&
           memcmp(at + k, JSON_MAGIC, sizeof JSON_MAGIC - 1) == 0;
}

static bool is_json(const char *text, size_t length) {
    return dalcs_description_is_text(text, length) && memchr(text, '{', length) != NULL &&
           strspn(text, " \t\r\n\xEF\xBB\xBF") == (size_t)(strchr(text, '{') - text);
}

/* ---- Inputs -------------------------------------------------------------------------------- */

/* TONES(offset delay amplitude frequency phase ...), into which AM and SFFM have been expanded. */
static bool read_tones(struct dalcs_reader *reader, struct dalcs_stimulus *s) {
    struct dalcs_tone tone[DALCS_STIMULUS_MOST_TERMS];
    int n = 0;
    reader->usage = "TONES(offset delay amplitude frequency cycles amplitude frequency ...)";
    bool opened = dalcs_reader_take(reader, DALCS_TOKEN_OPEN);
    bool ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "an offset", &s->u.tones.offset) &&
              dalcs_reader_list_number(reader, DALCS_PLAIN, "a delay", &s->u.tones.delay);
    while (ok && dalcs_reader_peek(reader, 0) != NULL &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0)) && n < DALCS_STIMULUS_MOST_TERMS) {
        ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "an amplitude", &tone[n].amplitude) &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a frequency", &tone[n].frequency) &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a phase in cycles", &tone[n].phase);
        n++;
    }
    if (!ok || (opened && !dalcs_reader_take(reader, DALCS_TOKEN_CLOSE))) {
        dalcs_reader_unexpected(reader);
        return false;
    }
    struct dalcs_tone *copy =
        dalcs_arena_alloc(&reader->builder->circuit->arena, (size_t)n, sizeof *copy);
    if (copy == NULL) {
        reader->builder->out_of_memory = true;
        return false;
    }
    memcpy(copy, tone, (size_t)n * sizeof *copy);
    s->kind = DALCS_STIMULUS_TONES;
    s->u.tones.n = n;
    s->u.tones.tone = copy;
    return true;
}

static bool read_function(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth);

/* Parts in formulas in formulas ... */
enum { DEEPEST_FORMULA = 64 };

/* factor (stimulus), up to the end. */
static bool read_parts(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    struct dalcs_arena *arena = &reader->builder->circuit->arena;
    const size_t most = (size_t)reader->card->n;
    struct dalcs_stimulus_summand *part = dalcs_arena_alloc(arena, most, sizeof *part);
    bool ok = part != NULL && depth < DEEPEST_FORMULA;
    int n_terms = 0;
    reader->builder->out_of_memory = reader->builder->out_of_memory || part == NULL;
    while (ok && dalcs_reader_peek(reader, 0) != NULL &&
           dalcs_reader_is_number(dalcs_reader_peek(reader, 0))) {
        struct dalcs_stimulus *of = dalcs_arena_alloc(arena, 1, sizeof *of);
        struct dalcs_stimulus_summand *next = &part[s->u.formula.argument.n++];
        reader->builder->out_of_memory = reader->builder->out_of_memory || of == NULL;
        next->of = of;
        ok = of != NULL &&
             dalcs_reader_list_number(reader, DALCS_PLAIN, "a factor", &next->factor) &&
             dalcs_reader_take(reader, DALCS_TOKEN_OPEN) && read_function(reader, of, depth + 1) &&
             dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
        n_terms += ok ? dalcs_stimulus_n_terms(of) : 0;
    }
    s->u.formula.argument.part = part;
    return ok && n_terms <= DALCS_STIMULUS_MOST_TERMS;
}

static bool read_knots(struct dalcs_reader *reader, struct dalcs_piecewise *f) {
    double n;
    if (!dalcs_reader_list_number(reader, DALCS_PLAIN, "a slope", &f->before) ||
        !dalcs_reader_list_number(reader, DALCS_PLAIN, "a slope", &f->after) ||
        !dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of knots", &n) ||
        !(n >= 1.0 && 4.0 * n <= (double)reader->card->n)) {
        return false;
    }
    f->n = (int)n;
    f->knot = dalcs_arena_alloc(&reader->builder->circuit->arena, (size_t)f->n, sizeof *f->knot);
    bool ok = f->knot != NULL;
    reader->builder->out_of_memory = reader->builder->out_of_memory || !ok;
    for (int k = 0; k < f->n && ok; k++) {
        struct dalcs_knot *knot = &f->knot[k];
        double *const value[] = {&knot->at, &knot->left, &knot->value, &knot->right};
        for (int i = 0; i < 4 && ok; i++) {
            ok = dalcs_reader_list_number(reader, DALCS_PLAIN, "a number of a knot", value[i]);
        }
        ok = ok && (k == 0 || knot->at > knot[-1].at);
    }
    return ok;
}

/* FORMULA(before after knots, at left value right of each, constant, factor (stimulus) ...): what a formula of sources
 * alone puts out. */
static bool read_formula(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    reader->usage =
        "FORMULA(before after knots at left value right ... constant factor (function) ...)";
    s->kind = DALCS_STIMULUS_FORMULA;
    const bool ok = dalcs_reader_take(reader, DALCS_TOKEN_OPEN) &&
                    read_knots(reader, &s->u.formula.function) &&
                    dalcs_reader_list_number(reader, DALCS_PLAIN, "a constant",
                                             &s->u.formula.argument.constant) &&
                    read_parts(reader, s, depth) && dalcs_reader_take(reader, DALCS_TOKEN_CLOSE);
    if (!ok) {
        dalcs_reader_unexpected(reader);
    }
    return ok;
}

static bool is_closed(struct dalcs_reader *reader) {
    const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
    return token != NULL && token->kind == DALCS_TOKEN_CLOSE;
}

/* input NAME [DC] [value] [function], or up to the parenthesis that closes a part of a formula */
static bool read_function(struct dalcs_reader *reader, struct dalcs_stimulus *s, int depth) {
    bool has_function = false;
    *s = (struct dalcs_stimulus){.kind = DALCS_STIMULUS_DC};
    while (!dalcs_reader_at_end(reader) && !(depth > 0 && is_closed(reader))) {
        const struct dalcs_token *token = dalcs_reader_peek(reader, 0);
        bool ok;
        if (!s->has_dc && (dalcs_reader_take_word(reader, "dc") || dalcs_reader_is_number(token))) {
            s->has_dc = true;
            ok = dalcs_reader_number(reader, DALCS_PLAIN, "a value", &s->dc);
        } else if (!has_function && dalcs_reader_take_word(reader, "tones")) {
            has_function = true;
            ok = read_tones(reader, s);
        } else if (!has_function && dalcs_reader_take_word(reader, "formula")) {
            has_function = true;
            ok = read_formula(reader, s, depth);
        } else if (!has_function && token->kind == DALCS_TOKEN_WORD &&
                   dalcs_waveform_card_is_name(token->text)) {
            has_function = true;
            ok = dalcs_waveform_card_parse(reader, DALCS_PLAIN, s);
        } else {
            dalcs_reader_unexpected(reader);
            ok = false;
        }
        if (!ok) {
            return false;
        }
    }
    if (!has_function && !s->has_dc) {
        dalcs_reader_missing(reader, "a value or a function: SIN, PULSE, PWL, EXP, AM or SFFM");
        return false;
    }
    return true;
}

static bool grow_inputs(struct dalcs_reading *r) {
    size_t capacity[3] = {r->input_capacity, r->input_capacity, r->input_capacity};
    bool ok = dalcs_grow(&r->input, &capacity[0], r->n_inputs + 1, sizeof *r->input) == DALCS_OK &&
              dalcs_grow(&r->input_name, &capacity[1], r->n_inputs + 1, sizeof *r->input_name) ==
                  DALCS_OK &&
              dalcs_grow(&r->input_token, &capacity[2], r->n_inputs + 1, sizeof *r->input_token) ==
                  DALCS_OK;
    r->input_capacity = ok ? capacity[2] : r->input_capacity;
    r->builder.out_of_memory = r->builder.out_of_memory || !ok;
    return ok;
}

static void take_input(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(
        &r->builder, card, "input name value, or input name SIN(...), PULSE, PWL, EXP, AM, SFFM");
    struct dalcs_stimulus s;
    const char *name = dalcs_reading_name(&reader, "a name");
    if (r->n_systems > 0 || r->network != &r->description->network) {
        dalcs_builder_error(&r->builder, card->token, NULL, "inputs come before the systems");
        return;
    }
    for (size_t k = 0; k < r->n_inputs && name != NULL; k++) {
        if (strcmp(r->input_name[k], name) == 0) {
            dalcs_builder_error(&r->builder, card->token, NULL, "a second input '%s'", name);
            return;
        }
    }
    if (name != NULL && read_function(&reader, &s, 0) && grow_inputs(r)) {
        r->input[r->n_inputs] = s;
        r->input_name[r->n_inputs] = name;
        r->input_token[r->n_inputs++] = card->token;
    }
}

/* ---- Systems ------------------------------------------------------------------------------- */

static void described_finish(struct dalcs_described_system *s) {
    free(s->state);
    free(s->unknown);
    free(s->row);
    free(s->multiplier);
    free(s->input);
    for (int k = 0; k < DALCS_N_BLOCKS; k++) {
        dalcs_triplets_finish(&s->block[k].entries);
    }
}

static struct dalcs_described_system *new_system(struct dalcs_reading *r,
                                                 const struct dalcs_card *card) {
    if (dalcs_grow(&r->system, &r->system_capacity, r->n_systems + 1, sizeof *r->system) !=
        DALCS_OK) {
        r->builder.out_of_memory = true;
        return NULL;
    }
    struct dalcs_described_system *s = &r->system[r->n_systems++];
    s->token = card->token;
    return s;
}

/* The system that a card belongs to: the last one, or the first. */
static struct dalcs_described_system *present_system(struct dalcs_reading *r,
                                                     const struct dalcs_card *card) {
    return r->n_systems > 0 ? &r->system[r->n_systems - 1] : new_system(r, card);
}

static enum dalcs_status list_inputs(struct dalcs_reading *r, struct dalcs_described_system *s) {
    for (size_t k = 0; !s->names_inputs && k < r->n_inputs; k++) {
        DALCS_TRY(dalcs_grow(&s->input, &s->input_capacity, s->n_inputs + 1, sizeof *s->input));
        s->input[s->n_inputs++] = (int)k;
    }
    return DALCS_OK;
}

/* A system that does not use an input has nothing to do at its edges. */
static enum dalcs_status drop_unused_inputs(struct dalcs_described_system *s) {
    static const enum dalcs_block_name of_inputs[] = {DALCS_BLOCK_E_I, DALCS_BLOCK_E_II,
                                                      DALCS_BLOCK_F, DALCS_BLOCK_DIRECT_CONTROL};

    const size_t n_blocks = sizeof of_inputs / sizeof of_inputs[0];
    int *index = dalcs_alloc(s->n_inputs, sizeof *index);
    if (index == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t b = 0; b < n_blocks; b++) {
        const struct dalcs_triplets *t = &s->block[of_inputs[b]].entries;
        for (size_t k = 0; k < t->n; k++) {
            index[t->entry[k].column] = 1;
        }
    }
    int n = 0;
    for (size_t k = 0; k < s->n_inputs; k++) {
        s->input[n] = s->input[k];
        index[k] = index[k] != 0 ? n++ : -1;
    }
    s->n_inputs = (size_t)n;
    for (size_t b = 0; b < n_blocks; b++) {
        struct dalcs_triplets *t = &s->block[of_inputs[b]].entries;
        for (size_t k = 0; k < t->n; k++) {
            t->entry[k].column = index[t->entry[k].column];
        }
    }
    free(index);
    return DALCS_OK;
}

static bool check_multipliers(struct dalcs_reading *r, const struct dalcs_described_system *s) {
    for (size_t j = 0; j < s->n_multipliers; j++) {
        if (s->n_coordinates == 0 && s->multiplier[j].constraint != DALCS_NO_CONSTRAINT) {
            dalcs_builder_error(&r->builder, s->token, NULL,
                                "'%s' belongs to a system of coordinates, of which there are none",
                                s->multiplier[j].pair.element);
            return false;
        }
    }
    return true;
}

static enum dalcs_status finish_system(struct dalcs_reading *r, size_t k) {
    struct dalcs_described_system *s = &r->system[k];
    DALCS_TRY(list_inputs(r, s));
    DALCS_TRY(dalcs_reading_fill_blocks(r, s));
    if (r->builder.failed || !check_multipliers(r, s)) {
        return DALCS_OK;
    }
    if (s->n_coordinates > 0) {
        DALCS_TRY(dalcs_mechanical_to_first_order(r, s));
        if (r->builder.failed) {
            return DALCS_OK;
        }
    }
    if (!s->names_inputs) {
        DALCS_TRY(drop_unused_inputs(s));
    }
    struct dalcs_network *n = r->network;
    DALCS_TRY(dalcs_system_of_description(r, s, &n->system[k], &n->initial[k]));
    n->n_systems = (int)k + 1;
    n->jumps_are_covered[k] = s->jumps_are_covered;
    return DALCS_OK;
}

/* The systems of the network at hand. */
static enum dalcs_status finish_systems(struct dalcs_reading *r) {
    struct dalcs_network *n = r->network;
    n->system = dalcs_alloc(r->n_systems, sizeof *n->system);
    n->initial = dalcs_alloc(r->n_systems, sizeof *n->initial);
    n->jumps_are_covered = dalcs_alloc(r->n_systems, sizeof *n->jumps_are_covered);
    if (n->system == NULL || n->initial == NULL || n->jumps_are_covered == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < r->n_systems && !r->builder.failed; k++) {
        DALCS_TRY(finish_system(r, k));
    }
    return DALCS_OK;
}

/* ---- Networks ------------------------------------------------------------------------------ */

static enum dalcs_status keep_outputs(struct dalcs_reading *r) {
    struct dalcs_network *n = r->network;
    n->output = dalcs_arena_alloc(&n->arena, r->n_outputs, sizeof *n->output);
    n->state = dalcs_arena_alloc(&n->arena, r->n_elements, sizeof *n->state);
    if (n->output == NULL || n->state == NULL) {
        return DALCS_E_NOMEM;
    }
    for (size_t k = 0; k < r->n_outputs; k++) {
        n->output[k] = r->output[k];
    }
    for (size_t k = 0; k < r->n_elements; k++) {
        n->state[k] = r->element[k];
    }
    n->n_outputs = (int)r->n_outputs;
    n->is_without_units = !r->has_units;
    n->n_states = (int)r->n_elements;
    r->n_outputs = 0;
    r->n_elements = 0;
    return DALCS_OK;
}

static bool is_output(const struct dalcs_card *card) {
    return strcmp(card->token->text, "output") == 0 || strcmp(card->token->text, "element") == 0;
}

/* Everything between two `network` cards. */
static enum dalcs_status finish_network(struct dalcs_reading *r, const struct dalcs_card *card,
                                        size_t n_cards) {
    DALCS_TRY(finish_systems(r));
    for (size_t k = 0; k < n_cards && !r->builder.failed; k++) {
        if (is_output(&card[k])) {
            dalcs_reading_take_output(r, &card[k]);
        }
    }
    if (r->network == &r->description->network && !r->builder.failed) {
        DALCS_TRY(dalcs_reading_default_outputs(r));
    }
    if (!r->builder.failed) {
        DALCS_TRY(keep_outputs(r));
    }
    for (size_t k = 0; k < r->n_systems; k++) {
        described_finish(&r->system[k]);
        r->system[k] = (struct dalcs_described_system){0};
    }
    r->n_systems = 0;
    return r->builder.out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

/* network main|charge|flux|held */
static bool begin_network(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_reader reader =
        dalcs_reader_start(&r->builder, card, "network main, charge, flux or held");
    struct dalcs_network *main = &r->description->network;
    struct dalcs_network **place[] = {&main->jump[DALCS_IMPULSE_CHARGE],
                                      &main->jump[DALCS_IMPULSE_FLUX], &main->held};
    static const char *const name[] = {"charge", "flux", "held"};
    if (dalcs_reader_take_word(&reader, "main")) {
        r->network = main;
        return dalcs_reader_end(&reader);
    }
    for (int k = 0; k < 3; k++) {
        if (*place[k] == NULL && dalcs_reader_take_word(&reader, name[k])) {
            *place[k] = dalcs_alloc(1, sizeof **place[k]);
            r->builder.out_of_memory = r->builder.out_of_memory || *place[k] == NULL;
            r->network = *place[k];
            return r->network != NULL && dalcs_reader_end(&reader);
        }
    }
    dalcs_reader_unexpected(&reader);
    return false;
}

/* ---- Cards --------------------------------------------------------------------------------- */

/* monotone yes|no: what is known of the OSNSP. */
static void take_claim(struct dalcs_reading *r, struct dalcs_described_system *s,
                       const struct dalcs_card *card) {
    struct dalcs_reader reader = dalcs_reader_start(&r->builder, card, "monotone yes, or no");
    if (dalcs_reader_take_word(&reader, "yes")) {
        s->monotone = DALCS_CLAIM_YES;
    } else if (dalcs_reader_take_word(&reader, "no")) {
        s->monotone = DALCS_CLAIM_NO;
    }
    (void)dalcs_reader_end(&reader);
}

static void take_system_card(struct dalcs_reading *r, const struct dalcs_card *card) {
    struct dalcs_described_system *s = present_system(r, card);
    const char *word = card->token->text;
    if (s == NULL) {
        return;
    }
    if (strcmp(word, "matrix") == 0) {
        dalcs_reading_take_matrix(r, s, card);
    } else if (strcmp(word, "monotone") == 0) {
        take_claim(r, s, card);
    } else if (strcmp(word, "jumps_are_covered") == 0) {
        s->jumps_are_covered = true;
    } else if (!dalcs_reading_take_column(r, s, card)) {
        static const char *const known[] = {
            "input",  "network", "system",   "inputs", "state",      "unknown", "row",
            "pair",   "switch",  "interval", "free",   "contact",    "joint",   "friction",
            "corner", "reverse", "matrix",   "output", "coordinate", "element", "monotone"};
        const char *hint =
            dalcs_reading_is_matrix(word)
                ? dalcs_builder_hint(&r->builder, "write: matrix %s, and its rows behind +", word)
                : dalcs_builder_suggest_of(&r->builder, known, sizeof known / sizeof known[0], word,
                                           "doc/system-file.md lists the cards");
        dalcs_builder_error(&r->builder, card->token, hint, "unknown card '%s' in a system file",
                            word);
    }
}

static void take_dot_card(struct dalcs_reading *r, const struct dalcs_card *card) {
    const char *word = card->token->text;
    if (strcmp(word, ".tran") == 0) {
        dalcs_analysis_parse_tran(&r->builder, card);
    } else if (strcmp(word, ".op") == 0) {
        dalcs_analysis_parse_op(&r->builder, card);
    } else if (strcmp(word, ".options") == 0 || strcmp(word, ".option") == 0 ||
               strcmp(word, ".opt") == 0) {
        dalcs_options_parse(&r->builder, card);
    } else {
        dalcs_builder_error(&r->builder, card->token,
                            "the cards are: .tran .op .options .param .func .end",
                            "'%s' has no meaning in a system file", word);
    }
}

static enum dalcs_status take_cards(struct dalcs_reading *r) {
    const struct dalcs_card *card = r->builder.deck->card;
    size_t n = r->builder.deck->n_cards;
    size_t first = 0;
    for (size_t k = 0; k < n && !r->builder.out_of_memory; k++) {
        const char *word = card[k].token->text;
        if (card[k].token->kind != DALCS_TOKEN_WORD) {
            dalcs_builder_error(&r->builder, card[k].token,
                                "rows of a matrix are on lines that start with +",
                                "a card cannot start with '%s'", word);
        } else if (card[k].letter == '.') {
            take_dot_card(r, &card[k]);
        } else if (strcmp(word, "input") == 0) {
            take_input(r, &card[k]);
        } else if (strcmp(word, "network") == 0) {
            if (k > 0 && (r->n_systems > 0 || r->network != &r->description->network)) {
                DALCS_TRY(finish_network(r, card + first, k - first));
            }
            first = k;
            if (!begin_network(r, &card[k])) {
                break;
            }
        } else if (strcmp(word, "system") == 0) {
            (void)new_system(r, &card[k]);
        } else if (!is_output(&card[k])) {
            take_system_card(r, &card[k]);
        }
    }
    if (r->builder.out_of_memory) {
        return DALCS_E_NOMEM;
    }
    return r->network == NULL ? DALCS_OK : finish_network(r, card + first, n - first);
}

/* ---- All together -------------------------------------------------------------------------- */

/* The circuit of no devices whose signals are the network's. */
static enum dalcs_status finish_circuit(struct dalcs_reading *r) {
    struct dalcs_circuit *c = &r->description->circuit;
    const struct dalcs_network *n = &r->description->network;
    c->stimulus = dalcs_arena_alloc(&c->arena, r->n_inputs, sizeof *c->stimulus);
    c->node_name = dalcs_arena_alloc(&c->arena, 1, sizeof *c->node_name);
    c->signal = dalcs_arena_alloc(&c->arena, (size_t)n->n_outputs, sizeof *c->signal);
    const char *title = r->builder.netlist->title + sizeof MAGIC - 1;
    title += strspn(title, " \t");
    c->title = dalcs_arena_copy(&c->arena, title, strlen(title));
    if (c->stimulus == NULL || c->node_name == NULL || c->signal == NULL || c->title == NULL) {
        return DALCS_E_NOMEM;
    }
    c->node_name[0] = "0";
    for (size_t k = 0; k < r->n_inputs; k++) {
        c->stimulus[k] = r->input[k];
    }
    c->n_stimuli = (int)r->n_inputs;
    for (int k = 0; k < n->n_outputs; k++) {
        c->signal[k] = (struct dalcs_signal){.name = n->output[k].name, .device = -1};
    }
    c->n_signals = n->n_outputs;
    for (size_t k = 0; k < r->n_inputs; k++) {
        dalcs_stimulus_check(&r->builder, r->input_token[k], &c->stimulus[k]);
    }
    return DALCS_OK;
}

/* Values of states are where the run starts: there is no operating point to start from then. */
static void start_from_values(struct dalcs_reading *r, bool has_values) {
    struct dalcs_transient *t = &r->description->circuit.transient;
    t->use_initial_conditions = t->use_initial_conditions || has_values;
}

static bool check_request(struct dalcs_reading *r) {
    const struct dalcs_location where = {.file = r->builder.netlist->name};
    if (!r->builder.failed && r->description->network.n_systems == 0) {
        dalcs_builder_error_at(&r->builder, &where, "columns are: state, unknown, pair, ...",
                               "the file has no system");
    }
    if (!r->builder.failed && r->builder.tran == NULL && r->builder.op == NULL) {
        dalcs_builder_error_at(&r->builder, &where, "add a line such as: .tran 10u 20m",
                               "the file has no analysis: no .tran and no .op");
    }
    return !r->builder.failed;
}

static bool has_values(const struct dalcs_deck *deck) {
    for (size_t k = 0; k < deck->n_cards; k++) {
        const struct dalcs_card *card = &deck->card[k];
        bool is_state =
            strcmp(card->token->text, "state") == 0 || strcmp(card->token->text, "coordinate") == 0;
        for (int i = 2; is_state && i < card->n; i++) {
            bool is_parameter = card->token[i - 1].kind == DALCS_TOKEN_EQUAL;
            if (!is_parameter && dalcs_reader_is_number(&card->token[i])) {
                return true;
            }
        }
    }
    return false;
}

static enum dalcs_status read_netlist(struct dalcs_reading *r, const struct dalcs_netlist *netlist,
                                      struct dalcs_diag *diag) {
    struct dalcs_deck deck = {0};
    r->builder.netlist = netlist;
    r->builder.deck = &deck;
    r->builder.diag = diag;
    r->builder.circuit = &r->description->circuit;
    r->network = &r->description->network;
    enum dalcs_status status = dalcs_deck_expand(&deck, netlist, diag);
    if (status == DALCS_OK) {
        r->builder.failed = netlist->has_errors || deck.has_errors;
        status = take_cards(r);
    }
    if (status == DALCS_OK && check_request(r)) {
        start_from_values(r, has_values(&deck));
        status = finish_circuit(r);
    }
    status = status == DALCS_OK && r->builder.out_of_memory ? DALCS_E_NOMEM : status;
    if (status == DALCS_OK && r->builder.failed) {
        status = diag->out_of_memory ? DALCS_E_NOMEM : DALCS_E_NETLIST;
    }
    dalcs_diag_sort(diag);
    dalcs_deck_finish(&deck);
    return status;
}

static enum dalcs_status read_cards(struct dalcs_description *description, const char *name,
                                    const char *text, size_t length, struct dalcs_diag *diag) {
    struct dalcs_netlist netlist = {0};
    struct dalcs_reading r = {.description = description};
    *description = (struct dalcs_description){.circuit = {.n_nodes = 1}};
    enum dalcs_status status = dalcs_netlist_read_text(&netlist, name, text, length, diag);
    if (status == DALCS_OK) {
        status = read_netlist(&r, &netlist, diag);
    }
    for (size_t k = 0; k < r.n_systems; k++) {
        described_finish(&r.system[k]);
    }
    free(r.system);
    free(r.input);
    free(r.input_name);
    free(r.input_token);
    free(r.output);
    free(r.element);
    dalcs_arena_finish(&r.builder.scratch);
    dalcs_netlist_finish(&netlist);
    if (status != DALCS_OK) {
        dalcs_description_finish(description);
    }
    return status;
}

enum dalcs_status dalcs_description_read_text(struct dalcs_description *description,
                                              const char *name, const char *text, size_t length,
                                              struct dalcs_diag *diag) {
    *description = (struct dalcs_description){0};
    if (!is_json(text, length)) {
        return read_cards(description, name, text, length, diag);
    }
    char *cards = NULL;
    size_t n;
    enum dalcs_status status = dalcs_json_to_cards(name, text, length, &cards, &n, diag);
    if (status == DALCS_OK) {
        status = read_cards(description, name, cards, n, diag);
    }
    free(cards);
    return status;
}

void dalcs_description_finish(struct dalcs_description *description) {
    dalcs_network_finish(&description->network);
    dalcs_circuit_finish(&description->circuit);
}
