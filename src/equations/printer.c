/* printer.c - names, numbers and terms. Widths are those of Computer Modern at 10 pt, a little too wide. */
#include "printer.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const double dalcs_latex_line = 455.0; /* 16 cm */

static const double wide = 5.6;  /* a letter */
static const double small = 4.2; /* of a subscript */

void dalcs_print_latex_begin(FILE *f) {
    fputs("\\documentclass[a4paper]{article}\n\\usepackage[utf8]{inputenc}\n"
          "\\usepackage[margin=2.5cm]{geometry}\n\\usepackage{amsmath,graphicx}\n"
          "\\allowdisplaybreaks\n\\begin{document}\n",
          f);
}

static void put(struct dalcs_printer *p, const char *text) {
    if (p->out != NULL) {
        fputs(text, p->out);
    }
}

void dalcs_print(struct dalcs_printer *p, const char *plain, const char *latex, double width) {
    put(p, p->latex ? latex : plain);
    p->width += width;
}

/* ---- Names --------------------------------------------------------------------------------- */

/* Bytes of a letter in UTF-8. */
static int length_of(unsigned char first) {
    return first < 0x80 ? 1 : first < 0xe0 ? 2 : first < 0xf0 ? 3 : 4;
}

static const char *greek_letter(const char *c) {
    static const char *const lower[] = {
        "alpha", "beta",   "gamma",   "delta", "epsilon", "zeta", "eta",  "theta", "iota",
        "kappa", "lambda", "mu",      "nu",    "xi",      NULL,   "pi",   "rho",   NULL,
        "sigma", "tau",    "upsilon", "phi",   "chi",     "psi",  "omega"};
    const unsigned char *u = (const unsigned char *)c;
    if (u[0] == 0xc2 && u[1] == 0xb5) {
        return "mu"; /* the micro sign */
    }
    if ((u[0] == 0xce && u[1] == 0xa9) || (u[0] == 0xe2 && u[1] == 0x84 && u[2] == 0xa6)) {
        return "Omega"; /* and the ohm sign */
    }
    if (u[0] == 0xce && u[1] == 0x94) {
        return "Delta";
    }
    int k = u[0] == 0xce ? u[1] - 0xb1 : u[0] == 0xcf ? u[1] - 0x80 + 15 : -1;
    return k >= 0 && k < (int)(sizeof lower / sizeof *lower) ? lower[k] : NULL;
}

/* Letters with accents that every font has, from A with grave to y with diaeresis. */
static bool has_glyph(const char *c) {
    const unsigned char *u = (const unsigned char *)c;
    return u[0] == 0xc3 && u[1] >= 0x80 && u[1] != 0x90 && u[1] != 0x9e && u[1] != 0xb0 &&
           u[1] != 0xbe;
}

void dalcs_print_name(struct dalcs_printer *p, const char *name) {
    if (!p->latex) {
        put(p, name);
        return;
    }
    static const char special[] = "\\~^<>|\"_#$%&{}";
    static const char *const as[] = {"\\textbackslash{}",
                                     "\\textasciitilde{}",
                                     "\\textasciicircum{}",
                                     "\\textless{}",
                                     "\\textgreater{}",
                                     "\\textbar{}",
                                     "''",
                                     "\\_",
                                     "\\#",
                                     "\\$",
                                     "\\%",
                                     "\\&",
                                     "\\{",
                                     "\\}"};
    for (const char *c = name; *c != '\0';) {
        char letter[8] = {0};
        int n = length_of((unsigned char)*c);
        const char *at = strchr(special, *c);
        if (at != NULL) {
            put(p, as[at - special]);
        } else if (n == 1) {
            letter[0] = *c == '\t' ? ' ' : *c;
            put(p, letter);
        } else if (greek_letter(c) != NULL) {
            put(p, "\\ensuremath{\\");
            put(p, greek_letter(c));
            put(p, "}");
        } else {
            snprintf(letter, sizeof letter, "%.*s", n, c);
            put(p, has_glyph(c) ? letter : "?"); /* LaTeX stops at what its fonts lack */
        }
        for (int k = 0; k < n && *c != '\0'; k++) {
            c++;
        }
        p->width += wide;
    }
}

static bool is_digit(char c) {
    return c >= '0' && c <= '9';
}

/* Nothing that stands for something else in LaTeX's formulas. */
static bool is_word(const char *name, size_t n) {
    for (size_t k = 0; k < n; k++) {
        bool is_letter = (name[k] >= 'a' && name[k] <= 'z') || (name[k] >= 'A' && name[k] <= 'Z');
        if (!is_letter && !is_digit(name[k]) && name[k] != '.') {
            return false;
        }
    }
    return true;
}

/* ",2" after the name where number is not 0. */
static void put_number_of(struct dalcs_printer *p, int number) {
    if (number != 0 && p->out != NULL) {
        fprintf(p->out, ",%d", number);
    }
}

static void put_subscript(struct dalcs_printer *p, const char *name, int number) {
    double before = p->width;
    put(p, is_word(name, strlen(name)) ? "_{\\mathrm{" : "_{\\text{");
    dalcs_print_name(p, name);
    put_number_of(p, number);
    put(p, "}}");
    p->width = before + small * (double)strlen(name);
}

static void put_dots(struct dalcs_printer *p, int n_dots) {
    put(p, n_dots == 0 ? "" : n_dots == 1 ? "\\dot " : "\\ddot ");
}

/* x1 of a system file is x with an index, d(q1) the derivative of q1. */
static void put_own_name(struct dalcs_printer *p, const char *name, int n_dots) {
    if (!p->latex) {
        put(p, name);
        return;
    }
    char base[64];
    size_t n = strlen(name);
    if (n > 3 && n < sizeof base && strncmp(name, "d(", 2) == 0 && name[n - 1] == ')') {
        snprintf(base, sizeof base, "%.*s", (int)(n - 3), name + 2);
        put_own_name(p, base, n_dots + 1);
        return;
    }
    size_t digits = n;
    while (digits > 0 && is_digit(name[digits - 1])) {
        digits--;
    }
    if (digits == 0 || digits >= sizeof base || !is_word(name, digits)) {
        put_dots(p, n_dots);
        put(p, "{\\text{");
        dalcs_print_name(p, name);
        put(p, "}}");
        return;
    }
    snprintf(base, sizeof base, "%.*s", (int)digits, name);
    put_dots(p, n_dots);
    put(p, digits > 1 ? "{\\mathit{" : "{");
    put(p, base);
    put(p, digits > 1 ? "}}" : "}");
    p->width += wide * (double)digits;
    if (digits < n) {
        put_subscript(p, name + digits, 0);
    }
}

void dalcs_print_element(struct dalcs_printer *p, const char *name) {
    bool is_lower = name[0] >= 'a' && name[0] <= 'z';
    char letter[2] = {(char)(is_lower ? name[0] - 'a' + 'A' : name[0]), '\0'};
    put(p, letter);
    p->width += wide;
    if (!p->latex) {
        put(p, name + 1);
    } else if (name[1] != '\0') {
        put_subscript(p, name + 1, 0);
    }
}

/* v(out) */
static void put_quantity(struct dalcs_printer *p, const char *letter, const char *name, int number,
                         int n_dots) {
    if (!p->latex) {
        put(p, letter);
        put(p, "(");
        put(p, name);
        put_number_of(p, number);
        put(p, ")");
        return;
    }
    put_dots(p, n_dots);
    put(p, letter);
    p->width += wide;
    put_subscript(p, name, number);
}

/* The lambdas of one B source are told apart by numbers. */
static void put_lambda(struct dalcs_printer *p, const struct dalcs_system *s, int d) {
    const struct dalcs_pair *pair = &s->pair[d];
    if (p->circuit->n_devices > 0 && !pair->is_formula) {
        put_quantity(p, "i", pair->element, 0, 0);
        if (pair->is_breakdown) {
            dalcs_print(p, "_rev", "^{\\mathrm{rev}}", 0.0);
        }
        return;
    }
    int before = 0;
    while (pair->is_formula && before < d &&
           strcmp(s->pair[d - before - 1].element, pair->element) == 0) {
        before++;
    }
    put_quantity(p, p->latex ? "\\lambda" : "lambda", pair->element,
                 pair->is_formula ? before + 1 : 0, 0);
}

void dalcs_print_column(struct dalcs_printer *p, const struct dalcs_system *s, int column,
                        int n_dots) {
    int n_equations = dalcs_system_n_equations(s);
    if (column >= n_equations) {
        put_lambda(p, s, column - n_equations);
    } else if (p->circuit->n_devices > 0) {
        put_quantity(p, s->column_is_current[column] ? "i" : "v", s->column[column].element, 0,
                     n_dots);
    } else {
        put_own_name(p, s->column[column].element, n_dots);
    }
}

void dalcs_print_input(struct dalcs_printer *p, const char *name) {
    bool word = is_word(name, strlen(name));
    dalcs_print(p, "", word ? "\\mathrm{" : "\\text{", 0.0);
    dalcs_print_name(p, name);
    dalcs_print(p, "(t)", "}(t)", 3.0 * wide);
}

/* ---- Numbers ------------------------------------------------------------------------------- */

void dalcs_print_number(struct dalcs_printer *p, double value) {
    dalcs_print_digits(p, value, 10);
}

void dalcs_print_digits(struct dalcs_printer *p, double value, int n_digits) {
    char text[64];
    snprintf(text, sizeof text, "%.*g", n_digits, value);
    char *exponent = strchr(text, 'e');
    if (p->latex && exponent != NULL) {
        long power = strtol(exponent + 1, NULL, 10);
        bool is_one = exponent == text + 1 && text[0] == '1';
        char *end = is_one ? text : exponent;
        snprintf(end, sizeof text - (size_t)(end - text), "%s10^{%ld}", is_one ? "" : "\\cdot ",
                 power);
        p->width += wide * (double)(end - text) + 5.0 * wide;
    } else {
        p->width += wide * (double)strlen(text);
    }
    put(p, text);
}

void dalcs_print_value(struct dalcs_printer *p, double value, const char *unit) {
    static const char *const plain[] = {"p", "n", "u", "m", "", "k", "M", "G"};
    static const char *const latex[] = {"\\mathrm{p", "\\mathrm{n", "\\mu\\mathrm{", "\\mathrm{m",
                                        "\\mathrm{",  "\\mathrm{k", "\\mathrm{M",    "\\mathrm{G"};
    int k = 4;
    double scale = 1.0;
    for (; k > 0 && value != 0.0 && fabs(value) / scale < 1.0 - 1e-9; k--) {
        scale *= 1e-3;
    }
    for (; k < 7 && fabs(value) / scale >= 1e3 * (1.0 - 1e-9); k++) {
        scale *= 1e3;
    }
    dalcs_print_number(p, value / scale);
    dalcs_print(p, " ", "\\,", 2.0);
    dalcs_print(p, plain[k], latex[k], wide);
    bool is_ohm = p->latex && strcmp(unit, "Ohm") == 0;
    put(p, is_ohm ? "\\Omega" : unit);
    dalcs_print(p, "", "}", wide);
}

/* ---- Sums ---------------------------------------------------------------------------------- */

void dalcs_print_factor(struct dalcs_printer *p, double value) {
    bool is_first = p->n_terms++ == 0;
    put(p, value < 0.0 ? (is_first ? "-" : " - ") : (is_first ? "" : " + "));
    p->width += is_first ? 0.0 : 12.5;
    if (fabs(value) != 1.0) {
        dalcs_print_number(p, fabs(value));
        dalcs_print(p, " ", "\\,", 2.0);
    }
}

void dalcs_print_sum_end(struct dalcs_printer *p) {
    if (p->n_terms == 0) {
        dalcs_print(p, "0", "0", wide);
    }
    p->n_terms = 0;
}
