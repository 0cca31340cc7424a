/* measuring.c - meas in a script: cards of the run before it.
 *
 * A measurement is made on the solution itself while the run goes on, when the vectors that `let` makes
 * behind the run do not exist yet. So where a card names such a vector, its formula is written there:
 *
 *     tran 1u 1m
 *     let p = out*l1#branch             p: (v(out)*i(l1))
 *     meas tran power avg p             meas tran power avg {v(out)*i(l1)}
 */
#include "meanings.h"

#include "lower_case.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static void add(struct dalcs_meanings *all, struct dalcs_meaning meaning) {
    if (meaning.name == NULL ||
        dalcs_grow(&all->meaning, &all->capacity, all->n + 1, sizeof *all->meaning) != DALCS_OK) {
        all->out_of_memory = true;
        return;
    }
    all->meaning[all->n++] = meaning;
}

const struct dalcs_meaning *dalcs_meanings_find(struct dalcs_meanings *all, const char *name) {
    for (size_t k = all->n; k > 0; k--) {
        if (strcmp(all->meaning[k - 1].name, name) == 0) {
            return &all->meaning[k - 1];
        }
    }
    struct dalcs_script *script = all->script;
    const struct dalcs_vector *v = dalcs_vectors_find_exactly(&script->vectors, name);
    if (v == NULL || v->n != 1 || v->is_complex) {
        return NULL;
    }
    const size_t n_before = all->n;
    add(all, (struct dalcs_meaning){
                 .name = dalcs_arena_copy(&script->arena, name, strlen(name)),
                 .text = dalcs_arena_printf(&script->arena, "%.17g", creal(v->value[0]))});
    return all->n > n_before ? &all->meaning[n_before] : NULL;
}

static enum dalcs_status start(struct dalcs_rewriting *r, struct dalcs_meanings *all,
                               const char *text) {
    *r = (struct dalcs_rewriting){
        .all = all,
        .at = text,
        .text = dalcs_arena_alloc(&all->script->arena, DALCS_LONGEST_REWRITING, 1)};
    return r->text != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* let name = formula */
static enum dalcs_status take_let(struct dalcs_meanings *all, const struct dalcs_statement *s) {
    struct dalcs_script *script = all->script;
    const char *text;
    script->is_silent = true; /* it is said when the statement's turn comes */
    const enum dalcs_status status = dalcs_script_expand_low(script, s, &text);
    script->is_silent = false;
    if (status == DALCS_E_NOMEM) {
        return status;
    }
    if (status != DALCS_OK) {
        text = s->rest;
    }
    const size_t n_name = strcspn(text, "=");
    const char *left = dalcs_arena_copy(&script->arena, text, n_name);
    const char *name = left != NULL ? dalcs_script_word(script, &left) : NULL;
    if (name == NULL || text[n_name] == '\0') {
        return left == NULL ? DALCS_E_NOMEM : DALCS_OK;
    }
    struct dalcs_meaning meaning = {.name = name,
                                    .cause = "its values are not known before the run"};
    if (status == DALCS_OK) {
        struct dalcs_rewriting r;
        DALCS_TRY(start(&r, all, text + n_name + 1));
        dalcs_rewriting_formula(&r);
        meaning.text = r.cause == NULL ? r.text : NULL;
        meaning.cause = r.cause;
    }
    add(all, meaning);
    return all->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

static bool is_among(const char *const *words, size_t n, const char *word) {
    bool is = false;
    for (size_t k = 0; k < n; k++) {
        is = is || strcmp(words[k], word) == 0;
    }
    return is;
}

/* Words of the card itself, the first of them before a vector. */
static bool is_keyword(const char *word, bool *takes_vector) {
    static const char *const before[] = {"avg",   "rms",        "integ",  "integral", "min",
                                         "max",   "pp",         "min_at", "max_at",   "find",
                                         "deriv", "derivative", "when",   "trig",     "targ"};
    static const char *const other[] = {"at",   "from",  "to",  "td",   "rise",
                                        "fall", "cross", "val", "last", "param"};
    *takes_vector = is_among(before, sizeof before / sizeof before[0], word);
    return *takes_vector || is_among(other, sizeof other / sizeof other[0], word);
}

/* The name of a node after max, when and so on, as ngspice has its voltage. */
static bool is_node(const struct dalcs_rewriting *r, const char *word, size_t n) {
    double value;
    const bool is_function = r->at[n + strspn(r->at + n, " \t")] == '(';
    return r->expects_vector && !is_function && strcmp(word, "time") != 0 &&
           dalcs_session_parameter(r->all->script->host->session, word, &value) == DALCS_E_OPTION;
}

/* A word of a card: the formula of a vector in its place, or itself. */
static void put_card_word(struct dalcs_rewriting *r, const char *as_written, size_t n) {
    struct dalcs_script *script = r->all->script;
    char *word = dalcs_arena_copy(&script->arena, as_written, n);
    if (word == NULL) {
        r->all->out_of_memory = true;
        return;
    }
    dalcs_lower_text(word);
    bool takes_vector;
    const bool is_own = is_keyword(word, &takes_vector) || dalcs_rewriting_is_signal(word);
    const struct dalcs_meaning *meaning = is_own ? NULL : dalcs_meanings_find(r->all, word);
    const char *branch = strstr(word, "#branch");
    if (meaning == NULL && branch != NULL && branch[7] == '\0') {
        dalcs_rewriting_put_text(r, "i(");
        dalcs_rewriting_put(r, as_written, (size_t)(branch - word));
        dalcs_rewriting_put_text(r, ")");
    } else if (meaning == NULL && !is_own && is_node(r, word, n)) {
        dalcs_rewriting_put_text(r, "v(");
        dalcs_rewriting_put(r, as_written, n);
        dalcs_rewriting_put_text(r, ")");
    } else if (meaning == NULL || meaning->is_result) {
        dalcs_rewriting_put(r, as_written, n);
    } else if (meaning->text == NULL) {
        r->cause = meaning->cause;
    } else {
        dalcs_rewriting_put_text(r, "{");
        dalcs_rewriting_put_text(r, meaning->text);
        dalcs_rewriting_put_text(r, "}");
    }
    r->expects_vector = takes_vector;
}

static void rewrite_next(struct dalcs_rewriting *r, bool is_free);

/* A phase in degrees, which the script has in radians: "ph(...)" of n letters becomes "(ph(...)*pi/180)". */
static bool put_phase(struct dalcs_rewriting *r, size_t n) {
    char word[8] = "";
    for (size_t k = 0; k < n && n < sizeof word; k++) {
        word[k] = dalcs_lower(r->at[k]);
    }
    const char *open = r->at + n + strspn(r->at + n, " \t");
    const size_t m = *open == '(' ? dalcs_rewriting_parenthesis(open) : 0;
    if (m == 0 || !dalcs_rewriting_is_turned(r, word)) {
        return false;
    }
    dalcs_rewriting_put_text(r, "(");
    dalcs_rewriting_put(r, r->at, n);
    r->at = open;
    if (dalcs_rewriting_is_signal(word)) { /* the names in it are none of the script's */
        dalcs_rewriting_put(r, open, m);
        r->at += m;
    }
    while (r->at < open + m && r->cause == NULL && !r->all->out_of_memory) {
        rewrite_next(r, false);
    }
    dalcs_rewriting_put_text(r, "*pi/180)");
    r->expects_vector = false;
    return true;
}

/* The next word of a card, or what stands between two. is_free: it is none of the script's names. */
static void rewrite_next(struct dalcs_rewriting *r, bool is_free) {
    const char *p = r->at;
    const char first = dalcs_lower(*p);
    size_t n = 1;
    if (dalcs_rewriting_is_letter(first)) {
        while (p[n] != '\0' && strchr(" \t,=()+-*/%^<>!&|{}'?@[]~", p[n]) == NULL) {
            n++;
        }
        const size_t n_blanks = strspn(p + n, " \t");
        if (!is_free && put_phase(r, n)) {
            return;
        }
        if (is_free) {
            dalcs_rewriting_put(r, p, n);
        } else {
            put_card_word(r, p, n);
        }
        r->at += n;
        /* the names in v(...) are none of the script's */
        if (p[n + n_blanks] == '(' && (first == 'v' || first == 'i') && n <= 3) {
            const size_t m = dalcs_rewriting_parenthesis(p + n + n_blanks);
            dalcs_rewriting_put(r, p + n + n_blanks, m);
            r->at += m > 0 ? n_blanks + m : 0;
        }
        return;
    }
    if (dalcs_rewriting_is_digit(*p)) {
        n = strcspn(p, " \t,=()*/%^<>!&|{}'?");
    } else if (*p == '@') {
        n = strcspn(p, "]");
        n += p[n] == ']';
    }
    dalcs_rewriting_put(r, p, n);
    r->at += n;
}

/* The card of a measurement, whose analysis and name are its first two words. */
static void rewrite_card(struct dalcs_rewriting *r) {
    int n_words = 0;
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        n_words += dalcs_rewriting_is_letter(dalcs_lower(*r->at));
        rewrite_next(r, n_words <= 2);
    }
}

/* A whole number that is set; otherwise what is usual. */
static long number_set(const struct dalcs_script *script, const char *name, long usual) {
    const char *text = dalcs_variables_get(&script->variables, name);
    const long n = text != NULL ? strtol(text, NULL, 10) : usual;
    return n >= 1 && n <= 10000 ? n : usual;
}

/* `fourier 50 v(out)`: the card has the numbers of harmonics and of periods besides, which here are set. ngspice's
 * nfreqs counts the constant. */
static void rewrite_fourier(struct dalcs_rewriting *r) {
    const struct dalcs_script *script = r->all->script;
    char numbers[64];
    const size_t n = strcspn(r->at, " \t");
    const long n_harmonics = number_set(script, "nfreqs", 10) - 1;
    dalcs_rewriting_put(r, r->at, n);
    r->at += n;
    snprintf(numbers, sizeof numbers, " %ld %ld", n_harmonics > 0 ? n_harmonics : 1,
             number_set(script, "nperiods", 1));
    dalcs_rewriting_put_text(r, numbers);
    r->expects_vector = true;
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        const size_t n_blanks = strspn(r->at, " \t,");
        dalcs_rewriting_put_text(r, n_blanks > 0 ? " " : "");
        r->at += n_blanks;
        r->expects_vector = true;
        rewrite_next(r, false);
    }
}

/* The second word: what the result is called. */
static enum dalcs_status add_result(struct dalcs_meanings *all, const char *text) {
    struct dalcs_script *script = all->script;
    (void)dalcs_script_word(script, &text);
    const char *word = dalcs_script_word(script, &text);
    char *name = word != NULL ? dalcs_arena_copy(&script->arena, word, strlen(word)) : NULL;
    if (name != NULL) {
        dalcs_lower_text(name);
        add(all, (struct dalcs_meaning){.name = name, .is_result = true});
    }
    return all->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

static enum dalcs_status take_measurement(struct dalcs_meanings *all,
                                          const struct dalcs_statement *s) {
    struct dalcs_script *script = all->script;
    const char *text;
    struct dalcs_rewriting r;
    const enum dalcs_status status = dalcs_script_expand(script, s, &text);
    if (status != DALCS_OK) {
        return status == DALCS_E_NETLIST ? DALCS_OK : status; /* a warning has told */
    }
    const bool is_fourier = strcmp(s->word, "fourier") == 0;
    DALCS_TRY(start(&r, all, text));
    if (is_fourier) {
        rewrite_fourier(&r);
    } else {
        rewrite_card(&r);
    }
    if (all->out_of_memory) {
        return DALCS_E_NOMEM;
    }
    if (r.cause != NULL) {
        (void)dalcs_script_refuse(script, s, "measure voltages and currents, or print the vector",
                                  "a vector of `let` cannot be measured: %s", r.cause);
        return DALCS_OK;
    }
    DALCS_TRY(dalcs_script_add_card(script, s, is_fourier ? "four" : "meas", r.text));
    return is_fourier ? DALCS_OK : add_result(all, text);
}

static bool ends_run(const struct dalcs_statement *s) {
    return s->kind == DALCS_STATEMENT_ANALYSIS || s->kind == DALCS_STATEMENT_END ||
           s->kind == DALCS_STATEMENT_ELSE || s->kind == DALCS_STATEMENT_QUIT;
}

/* Does the first measurement say that it is of .ac? */
static bool measures_ac(const struct dalcs_statements *all, size_t first) {
    size_t k = first;
    while (k < all->n && all->statement[k].kind != DALCS_STATEMENT_MEASURE) {
        k++;
    }
    const char *rest = k < all->n ? all->statement[k].rest : "";
    return (rest[0] == 'a' || rest[0] == 'A') && (rest[1] == 'c' || rest[1] == 'C');
}

enum dalcs_status dalcs_script_add_measurements(struct dalcs_script *script, size_t first) {
    const struct dalcs_statements *statements = &script->statements;
    struct dalcs_meanings all = {.script = script,
                                 .is_ac = measures_ac(statements, first),
                                 .in_degrees = script->vectors.in_degrees};
    enum dalcs_status status = DALCS_OK;
    for (size_t k = first; k < statements->n && status == DALCS_OK; k++) {
        const struct dalcs_statement *s = &statements->statement[k];
        if (ends_run(s)) {
            break;
        }
        if (s->kind == DALCS_STATEMENT_SET || s->kind == DALCS_STATEMENT_UNSET) {
            all.in_degrees = dalcs_script_has_degrees(s, all.in_degrees);
        } else if (s->kind == DALCS_STATEMENT_LET) {
            status = take_let(&all, s);
        } else if (s->kind == DALCS_STATEMENT_MEASURE) {
            status = take_measurement(&all, s);
        }
    }
    free(all.meaning);
    return status;
}
