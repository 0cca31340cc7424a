/* measuring.c - meas in a script: cards of the run before it.
 *
 * A measurement is made on the solution itself while the run goes on, when the vectors that `let` makes
 * behind the run do not exist yet. So where a card names such a vector, its formula is written there:
 *
 *     tran 1u 1m
 *     let p = out*l1#branch             p: (v(out)*i(l1))
 *     meas tran power avg p             meas tran power avg {v(out)*i(l1)}
 */
#include "lower_case.h"
#include "names.h"
#include "script_internal.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { LONGEST = 8000 };

/* What a name means on the cards of a run. */
struct meaning {
    const char *name;
    const char *text;  /* NULL: it cannot be measured, */
    const char *cause; /* for this */
    bool is_result;    /* of a measurement: cards refer to it by its name */
};

struct meanings {
    struct dalcs_script *script;
    struct meaning *meaning; /* heap */
    size_t n, capacity;
    bool is_ac;
    bool out_of_memory;
};

static void add(struct meanings *all, struct meaning meaning) {
    if (meaning.name == NULL ||
        dalcs_grow(&all->meaning, &all->capacity, all->n + 1, sizeof *all->meaning) != DALCS_OK) {
        all->out_of_memory = true;
        return;
    }
    all->meaning[all->n++] = meaning;
}

/* NULL: nothing that the script made. What it made before the run has a value already. */
static const struct meaning *find(struct meanings *all, const char *name) {
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
    add(all,
        (struct meaning){.name = dalcs_arena_copy(&script->arena, name, strlen(name)),
                         .text = dalcs_arena_printf(&script->arena, "%.17g", creal(v->value[0]))});
    return all->n > n_before ? &all->meaning[n_before] : NULL;
}

/* ---- Words ------------------------------------------------------------------------------------- */

/* A text that is read while another one is written. */
struct rewriting {
    struct meanings *all;
    const char *at;
    char *text; /* so far, in the arena of the statement */
    size_t n;
    const char *cause;   /* why it cannot be measured, or NULL */
    bool expects_vector; /* the word before says so */
};

static void put(struct rewriting *r, const char *text, size_t n) {
    if (r->n + n >= LONGEST) {
        r->cause = "its formula becomes too long";
        return;
    }
    memcpy(r->text + r->n, text, n);
    r->n += n;
    r->text[r->n] = '\0';
}

static void put_text(struct rewriting *r, const char *text) {
    put(r, text, strlen(text));
}

static bool is_letter(char c) {
    return (c >= 'a' && c <= 'z') || c == '_' || (unsigned char)c >= 0x80;
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

static size_t word_length(const char *text) {
    size_t n = 0;
    while (is_letter(text[n]) || is_digit(text[n]) ||
           (text[n] != '\0' && strchr(".#:$", text[n]))) {
        n++;
    }
    return n;
}

static size_t number_length(const char *text) {
    size_t n = 0;
    while (is_digit(text[n]) || text[n] == '.' || is_letter(text[n]) ||
           ((text[n] == '+' || text[n] == '-') && n > 0 && text[n - 1] == 'e' &&
            is_digit(text[n + 1]))) {
        n++;
    }
    return n;
}

/* From an opening parenthesis to the closing one, both included; 0: there is none. */
static size_t parenthesis_length(const char *text) {
    int depth = 0;
    for (size_t n = 0; text[n] != '\0'; n++) {
        depth += (text[n] == '(') - (text[n] == ')');
        if (depth == 0) {
            return n + 1;
        }
    }
    return 0;
}

/* v(a), vdb(a,b), i(x): the text in the parentheses is no formula. */
static bool is_signal(const char *word) {
    static const char *const suffix[] = {"", "m", "p", "r", "i", "db"};
    bool is = false;
    for (size_t k = 0; (*word == 'v' || *word == 'i') && k < sizeof suffix / sizeof suffix[0];
         k++) {
        is = is || strcmp(word + 1, suffix[k]) == 0;
    }
    return is;
}

/* ---- What `let` made ----------------------------------------------------------------------------- */

/* A function of vectors as measurements have it; `argument` follows, with its parentheses. */
static void put_function(struct rewriting *r, const char *word, const char *argument) {
    static const char *const same[] = {"abs",  "sqrt", "exp",  "ln",   "log",  "log10", "sin",
                                       "cos",  "tan",  "atan", "sinh", "cosh", "tanh",  "floor",
                                       "ceil", "mag",  "db",   "re",   "real", "im",    "imag"};
    /* of a complex voltage alone, by the letters behind v */
    static const char *const part[][2] = {{"mag", "vm"},  {"db", "vdb"}, {"re", "vr"},
                                          {"real", "vr"}, {"im", "vi"},  {"imag", "vi"}};
    bool is_known = false;
    const char *letters = NULL;
    for (size_t k = 0; k < sizeof same / sizeof same[0]; k++) {
        is_known = is_known || strcmp(same[k], word) == 0;
    }
    for (size_t k = 0; k < sizeof part / sizeof part[0]; k++) {
        letters = strcmp(part[k][0], word) == 0 ? part[k][1] : letters;
    }
    const char *inner = argument + 1 + strspn(argument + 1, " ");
    const bool is_voltage = strncmp(inner, "v(", 2) == 0;
    const size_t n = is_voltage ? 1 + parenthesis_length(inner + 1) : word_length(inner);
    const char *behind = inner + n + strspn(inner + n, " ");
    char *word_inside = dalcs_arena_copy(&r->all->script->arena, inner, n);
    if (word_inside == NULL) {
        r->all->out_of_memory = true;
        return;
    }
    const bool is_one = n > (is_voltage ? 1U : 0U) && *behind == ')' &&
                        (is_voltage || find(r->all, word_inside) == NULL);
    if (letters != NULL && r->all->is_ac && is_one) {
        put_text(r, letters);
        put_text(r, is_voltage ? "" : "(");
        put(r, inner + is_voltage, n - is_voltage);
        put_text(r, is_voltage ? "" : ")");
        r->at = behind + 1;
    } else if (letters == NULL && is_known) {
        put_text(r, word);
    } else if (strcmp(word, "mag") == 0 && !r->all->is_ac) {
        put_text(r, "abs");
    } else {
        r->cause = "measurements do not have one of its functions";
    }
}

/* lt, and, ... */
static bool put_operator(struct rewriting *r, const char *word) {
    static const char *const pair[][2] = {{"lt", "<"},   {"gt", ">"},  {"le", "<="},
                                          {"ge", ">="},  {"eq", "=="}, {"ne", "!="},
                                          {"and", "&&"}, {"or", "||"}, {"not", "!"}};
    for (size_t k = 0; k < sizeof pair / sizeof pair[0]; k++) {
        if (strcmp(pair[k][0], word) == 0) {
            put_text(r, pair[k][1]);
            return true;
        }
    }
    return false;
}

/* A name in a formula of vectors: of another `let`, of a current, of a parameter or of a node. */
static void put_name(struct rewriting *r, const char *word) {
    const struct meaning *meaning = find(r->all, word);
    const char *branch = strstr(word, "#branch");
    double value;
    if (meaning != NULL && meaning->text == NULL && !meaning->is_result) {
        r->cause = meaning->cause;
    } else if (meaning != NULL && !meaning->is_result) {
        put_text(r, "(");
        put_text(r, meaning->text);
        put_text(r, ")");
    } else if (branch != NULL) {
        put_text(r, "i(");
        put(r, word, (size_t)(branch - word));
        put_text(r, ")");
    } else if (meaning != NULL || strcmp(word, "time") == 0 || strcmp(word, "frequency") == 0 ||
               strcmp(word, "pi") == 0 ||
               dalcs_session_parameter(r->all->script->host->session, word, &value) == DALCS_OK) {
        put_text(r, word);
    } else {
        put_text(r, "v(");
        put_text(r, word);
        put_text(r, ")");
    }
}

static void put_word(struct rewriting *r, const char *word) {
    const size_t n_blanks = strspn(r->at, " \t");
    if (r->at[n_blanks] != '(') {
        if (!put_operator(r, word)) {
            put_name(r, word);
        }
        return;
    }
    const size_t n = parenthesis_length(r->at + n_blanks);
    if (n == 0) {
        r->cause = "a parenthesis of it is never closed";
    } else if (is_signal(word)) {
        put_text(r, word);
        put(r, r->at + n_blanks, n);
        r->at += n_blanks + n;
    } else if (!put_operator(r, word)) {
        put_function(r, word, r->at + n_blanks);
    }
}

/* A formula of vectors, in lower case, as a card has it. */
static void rewrite_formula(struct rewriting *r) {
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        const char *p = r->at;
        size_t n = 1;
        if (is_letter(*p)) {
            n = word_length(p);
            const char *word = dalcs_arena_copy(&r->all->script->arena, p, n);
            r->at += n;
            if (word == NULL) {
                r->all->out_of_memory = true;
            } else {
                put_word(r, word);
            }
            continue;
        }
        if (is_digit(*p)) {
            n = number_length(p);
        } else if (*p == '@') {
            n = strcspn(p, "]");
            n += p[n] == ']';
        } else if (*p == '[') {
            r->cause = "it holds an index";
        } else if (*p == '~') {
            p = "!";
        }
        put(r, p, n);
        r->at += n;
    }
}

/* ---- Statements ---------------------------------------------------------------------------------- */

static enum dalcs_status start(struct rewriting *r, struct meanings *all, const char *text) {
    *r = (struct rewriting){
        .all = all, .at = text, .text = dalcs_arena_alloc(&all->script->arena, LONGEST, 1)};
    return r->text != NULL ? DALCS_OK : DALCS_E_NOMEM;
}

/* let name = formula */
static enum dalcs_status take_let(struct meanings *all, const struct dalcs_statement *s) {
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
    struct meaning meaning = {.name = name, .cause = "its values are not known before the run"};
    if (status == DALCS_OK) {
        struct rewriting r;
        DALCS_TRY(start(&r, all, text + n_name + 1));
        rewrite_formula(&r);
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
static bool is_node(const struct rewriting *r, const char *word, size_t n) {
    double value;
    const bool is_function = r->at[n + strspn(r->at + n, " \t")] == '(';
    return r->expects_vector && !is_function && strcmp(word, "time") != 0 &&
           dalcs_session_parameter(r->all->script->host->session, word, &value) == DALCS_E_OPTION;
}

/* A word of a card: the formula of a vector in its place, or itself. */
static void put_card_word(struct rewriting *r, const char *as_written, size_t n) {
    struct dalcs_script *script = r->all->script;
    char *word = dalcs_arena_copy(&script->arena, as_written, n);
    if (word == NULL) {
        r->all->out_of_memory = true;
        return;
    }
    dalcs_lower_text(word);
    bool takes_vector;
    const bool is_own = is_keyword(word, &takes_vector) || is_signal(word);
    const struct meaning *meaning = is_own ? NULL : find(r->all, word);
    const char *branch = strstr(word, "#branch");
    if (meaning == NULL && branch != NULL && branch[7] == '\0') {
        put_text(r, "i(");
        put(r, as_written, (size_t)(branch - word));
        put_text(r, ")");
    } else if (meaning == NULL && !is_own && is_node(r, word, n)) {
        put_text(r, "v(");
        put(r, as_written, n);
        put_text(r, ")");
    } else if (meaning == NULL || meaning->is_result) {
        put(r, as_written, n);
    } else if (meaning->text == NULL) {
        r->cause = meaning->cause;
    } else {
        put_text(r, "{");
        put_text(r, meaning->text);
        put_text(r, "}");
    }
    r->expects_vector = takes_vector;
}

/* The next word of a card, or what stands between two. is_free: it is none of the script's names. */
static void rewrite_next(struct rewriting *r, bool is_free) {
    const char *p = r->at;
    const char first = dalcs_lower(*p);
    size_t n = 1;
    if (is_letter(first)) {
        while (p[n] != '\0' && strchr(" \t,=()+-*/%^<>!&|{}'?@[]~", p[n]) == NULL) {
            n++;
        }
        const size_t n_blanks = strspn(p + n, " \t");
        if (is_free) {
            put(r, p, n);
        } else {
            put_card_word(r, p, n);
        }
        r->at += n;
        /* the names in v(...) are none of the script's */
        if (p[n + n_blanks] == '(' && (first == 'v' || first == 'i') && n <= 3) {
            const size_t m = parenthesis_length(p + n + n_blanks);
            put(r, p + n + n_blanks, m);
            r->at += m > 0 ? n_blanks + m : 0;
        }
        return;
    }
    if (is_digit(*p)) {
        n = strcspn(p, " \t,=()*/%^<>!&|{}'?");
    } else if (*p == '@') {
        n = strcspn(p, "]");
        n += p[n] == ']';
    }
    put(r, p, n);
    r->at += n;
}

/* The card of a measurement, whose analysis and name are its first two words. */
static void rewrite_card(struct rewriting *r) {
    int n_words = 0;
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        n_words += is_letter(dalcs_lower(*r->at));
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
static void rewrite_fourier(struct rewriting *r) {
    const struct dalcs_script *script = r->all->script;
    char numbers[64];
    const size_t n = strcspn(r->at, " \t");
    const long n_harmonics = number_set(script, "nfreqs", 10) - 1;
    put(r, r->at, n);
    r->at += n;
    snprintf(numbers, sizeof numbers, " %ld %ld", n_harmonics > 0 ? n_harmonics : 1,
             number_set(script, "nperiods", 1));
    put_text(r, numbers);
    r->expects_vector = true;
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        const size_t n_blanks = strspn(r->at, " \t,");
        put_text(r, n_blanks > 0 ? " " : "");
        r->at += n_blanks;
        r->expects_vector = true;
        rewrite_next(r, false);
    }
}

/* The second word: what the result is called. */
static enum dalcs_status add_result(struct meanings *all, const char *text) {
    struct dalcs_script *script = all->script;
    (void)dalcs_script_word(script, &text);
    const char *word = dalcs_script_word(script, &text);
    char *name = word != NULL ? dalcs_arena_copy(&script->arena, word, strlen(word)) : NULL;
    if (name != NULL) {
        dalcs_lower_text(name);
        add(all, (struct meaning){.name = name, .is_result = true});
    }
    return all->out_of_memory ? DALCS_E_NOMEM : DALCS_OK;
}

static enum dalcs_status take_measurement(struct meanings *all, const struct dalcs_statement *s) {
    struct dalcs_script *script = all->script;
    const char *text;
    struct rewriting r;
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
    struct meanings all = {.script = script, .is_ac = measures_ac(statements, first)};
    enum dalcs_status status = DALCS_OK;
    for (size_t k = first; k < statements->n && status == DALCS_OK; k++) {
        const struct dalcs_statement *s = &statements->statement[k];
        if (ends_run(s)) {
            break;
        }
        if (s->kind == DALCS_STATEMENT_LET) {
            status = take_let(&all, s);
        } else if (s->kind == DALCS_STATEMENT_MEASURE) {
            status = take_measurement(&all, s);
        }
    }
    free(all.meaning);
    return status;
}
