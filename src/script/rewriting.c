/* rewriting.c - a formula of the script as one of a card: names that `let` has made are what they stand for. */
#include "meanings.h"

#include <stdlib.h>
#include <string.h>

void dalcs_rewriting_put(struct dalcs_rewriting *r, const char *text, size_t n) {
    if (r->n + n >= DALCS_LONGEST_REWRITING) {
        r->cause = "its formula becomes too long";
        return;
    }
    memcpy(r->text + r->n, text, n);
    r->n += n;
    r->text[r->n] = '\0';
}

void dalcs_rewriting_put_text(struct dalcs_rewriting *r, const char *text) {
    dalcs_rewriting_put(r, text, strlen(text));
}

bool dalcs_rewriting_is_letter(char c) {
    return (c >= 'a' && c <= 'z') || c == '_' || (unsigned char)c >= 0x80;
}

bool dalcs_rewriting_is_digit(char c) {
    return c >= '0' && c <= '9';
}

static size_t word_length(const char *text) {
    size_t n = 0;
    while (dalcs_rewriting_is_letter(text[n]) || dalcs_rewriting_is_digit(text[n]) ||
           (text[n] != '\0' && strchr(".#:$", text[n]))) {
        n++;
    }
    return n;
}

static size_t number_length(const char *text) {
    size_t n = 0;
    while (dalcs_rewriting_is_digit(text[n]) || text[n] == '.' ||
           dalcs_rewriting_is_letter(text[n]) ||
           ((text[n] == '+' || text[n] == '-') && n > 0 && text[n - 1] == 'e' &&
            dalcs_rewriting_is_digit(text[n + 1]))) {
        n++;
    }
    return n;
}

size_t dalcs_rewriting_parenthesis(const char *text) {
    int depth = 0;
    for (size_t n = 0; text[n] != '\0'; n++) {
        depth += (text[n] == '(') - (text[n] == ')');
        if (depth == 0) {
            return n + 1;
        }
    }
    return 0;
}

bool dalcs_rewriting_is_signal(const char *word) {
    static const char *const suffix[] = {"", "m", "p", "r", "i", "db"};
    bool is = false;
    for (size_t k = 0; (*word == 'v' || *word == 'i') && k < sizeof suffix / sizeof suffix[0];
         k++) {
        is = is || strcmp(word + 1, suffix[k]) == 0;
    }
    return is && strcmp(word, "im") != 0; /* the imaginary part */
}

bool dalcs_rewriting_is_turned(const struct dalcs_rewriting *r, const char *word) {
    return !r->all->in_degrees && (strcmp(word, "vp") == 0 || strcmp(word, "ip") == 0 ||
                                   strcmp(word, "ph") == 0 || strcmp(word, "phase") == 0);
}

/* A function of vectors as measurements have it; `argument` follows, with its parentheses. */
static void put_function(struct dalcs_rewriting *r, const char *word, const char *argument) {
    static const char *const same[] = {"abs",  "sqrt", "exp",  "ln",   "log",  "log10", "sin",
                                       "cos",  "tan",  "atan", "sinh", "cosh", "tanh",  "floor",
                                       "ceil", "mag",  "db",   "re",   "real", "im",    "imag"};
    /* of a complex voltage alone, by the letters behind v */
    static const char *const part[][2] = {{"mag", "vm"},  {"db", "vdb"},  {"re", "vr"},
                                          {"real", "vr"}, {"im", "vi"},   {"imag", "vi"},
                                          {"ph", "vp"},   {"phase", "vp"}};
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
    const size_t n = is_voltage ? 1 + dalcs_rewriting_parenthesis(inner + 1) : word_length(inner);
    const char *behind = inner + n + strspn(inner + n, " ");
    char *word_inside = dalcs_arena_copy(&r->all->script->arena, inner, n);
    if (word_inside == NULL) {
        r->all->out_of_memory = true;
        return;
    }
    const bool is_one = n > (is_voltage ? 1U : 0U) && *behind == ')' &&
                        (is_voltage || dalcs_meanings_find(r->all, word_inside) == NULL);
    if (letters != NULL && r->all->is_ac && is_one) {
        const bool is_turned = dalcs_rewriting_is_turned(r, word);
        dalcs_rewriting_put_text(r, is_turned ? "(" : "");
        dalcs_rewriting_put_text(r, letters);
        dalcs_rewriting_put_text(r, is_voltage ? "" : "(");
        dalcs_rewriting_put(r, inner + is_voltage, n - is_voltage);
        dalcs_rewriting_put_text(r, is_voltage ? "" : ")");
        dalcs_rewriting_put_text(r, is_turned ? "*pi/180)" : "");
        r->at = behind + 1;
    } else if (letters == NULL && is_known) {
        dalcs_rewriting_put_text(r, word);
    } else if (strcmp(word, "mag") == 0 && !r->all->is_ac) {
        dalcs_rewriting_put_text(r, "abs");
    } else {
        r->cause = "measurements do not have one of its functions";
    }
}

/* lt, and, ... */
static bool put_operator(struct dalcs_rewriting *r, const char *word) {
    static const char *const pair[][2] = {{"lt", "<"},   {"gt", ">"},  {"le", "<="},
                                          {"ge", ">="},  {"eq", "=="}, {"ne", "!="},
                                          {"and", "&&"}, {"or", "||"}, {"not", "!"}};
    for (size_t k = 0; k < sizeof pair / sizeof pair[0]; k++) {
        if (strcmp(pair[k][0], word) == 0) {
            dalcs_rewriting_put_text(r, pair[k][1]);
            return true;
        }
    }
    return false;
}

/* A name in a formula of vectors: of another `let`, of a current, of a parameter or of a node. */
static void put_name(struct dalcs_rewriting *r, const char *word) {
    const struct dalcs_meaning *meaning = dalcs_meanings_find(r->all, word);
    const char *branch = strstr(word, "#branch");
    double value;
    if (meaning != NULL && meaning->text == NULL && !meaning->is_result) {
        r->cause = meaning->cause;
    } else if (meaning != NULL && !meaning->is_result) {
        dalcs_rewriting_put_text(r, "(");
        dalcs_rewriting_put_text(r, meaning->text);
        dalcs_rewriting_put_text(r, ")");
    } else if (branch != NULL) {
        dalcs_rewriting_put_text(r, "i(");
        dalcs_rewriting_put(r, word, (size_t)(branch - word));
        dalcs_rewriting_put_text(r, ")");
    } else if (meaning != NULL || strcmp(word, "time") == 0 || strcmp(word, "frequency") == 0 ||
               strcmp(word, "pi") == 0 ||
               dalcs_session_parameter(r->all->script->host->session, word, &value) == DALCS_OK) {
        dalcs_rewriting_put_text(r, word);
    } else {
        dalcs_rewriting_put_text(r, "v(");
        dalcs_rewriting_put_text(r, word);
        dalcs_rewriting_put_text(r, ")");
    }
}

static void put_word(struct dalcs_rewriting *r, const char *word) {
    const size_t n_blanks = strspn(r->at, " \t");
    if (r->at[n_blanks] != '(') {
        if (!put_operator(r, word)) {
            put_name(r, word);
        }
        return;
    }
    const size_t n = dalcs_rewriting_parenthesis(r->at + n_blanks);
    if (n == 0) {
        r->cause = "a parenthesis of it is never closed";
    } else if (dalcs_rewriting_is_signal(word)) {
        const bool is_turned = dalcs_rewriting_is_turned(r, word);
        dalcs_rewriting_put_text(r, is_turned ? "(" : "");
        dalcs_rewriting_put_text(r, word);
        dalcs_rewriting_put(r, r->at + n_blanks, n);
        dalcs_rewriting_put_text(r, is_turned ? "*pi/180)" : "");
        r->at += n_blanks + n;
    } else if (!put_operator(r, word)) {
        put_function(r, word, r->at + n_blanks);
    }
}

void dalcs_rewriting_formula(struct dalcs_rewriting *r) {
    while (*r->at != '\0' && r->cause == NULL && !r->all->out_of_memory) {
        const char *p = r->at;
        size_t n = 1;
        if (dalcs_rewriting_is_letter(*p)) {
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
        if (dalcs_rewriting_is_digit(*p)) {
            n = number_length(p);
        } else if (*p == '@') {
            n = strcspn(p, "]");
            n += p[n] == ']';
        } else if (*p == '[') {
            r->cause = "it holds an index";
        } else if (*p == '~') {
            p = "!";
        }
        dalcs_rewriting_put(r, p, n);
        r->at += n;
    }
}
