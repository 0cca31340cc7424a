/* test_system_file.c - what is read is what was written, to the bit; damage is refused in peace. */
#include "system_file.h"

#include "build_network.h"

#include <errno.h>
#include <float.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static struct text_network t;
static char path[64];
static struct dalcs_diag diag;

static const char *const circuit[] = {
    "a diode across a source\nV1 1 0 1\nD1 1 0\n.op\n",
    "breakdown, switches, a floating side\nV1 a b 1\nR0 b 0 1\nL1 a b 1m\nL2 p m 3m\nK1 L1 L2 0.3\n"
    "D1 p q dz\nC1 q m 1u\nR1 q m 0.3\nS1 q m a b sm on\nS2 q m q m sm\n"
    ".model dz D(Ron=0.1 Vrev=5)\n.model sm SW(Vt=0.1 Vh=1e-300)\n.tran 1u 1m\n",
    "no diode\nI1 0 a 1\nC1 a 0 1\nE1 b 0 a 0 0.1\nR1 b 0 1\n.tran 1 9\n",
};

enum { N_CIRCUITS = sizeof(circuit) / sizeof(circuit[0]) };

/* Numbers that a careless printf or scanf would lose. */
static const double nasty[] = {1.0 / 3.0, -0.0,         DBL_TRUE_MIN,
                               DBL_MAX,   -DBL_EPSILON, 0x1.fffffffffffffp-7};

static void write_system(const struct dalcs_system *s, double *u, uint64_t mode) {
    for (int i = 0; i < s->n_x + s->n_inputs; i++) {
        u[i] = nasty[i % (int)(sizeof(nasty) / sizeof(nasty[0]))];
    }
    snprintf(path, sizeof(path), "test_system_file.%d", (int)getpid());
    const struct dalcs_system_step step = {
        .sigma = 1.0 / 3e-7, .u = u, .mode = &mode, .about = "a step\nof a test"};
    ck_assert_int_eq(dalcs_system_file_write(path, s, &step), DALCS_OK);
}

static void check_labels(const struct dalcs_label *a, const struct dalcs_label *b, int n) {
    for (int k = 0; k < n; k++) {
        ck_assert_int_eq(a[k].kind, b[k].kind);
        ck_assert_str_eq(a[k].element, b[k].element);
    }
}

static void check_matrix(const struct dalcs_csr *a, const struct dalcs_csr *b) {
    ck_assert_int_eq(a->n_rows, b->n_rows);
    ck_assert_int_eq(a->n_columns, b->n_columns);
    ck_assert_mem_eq(a->p, b->p, ((size_t)a->n_rows + 1) * sizeof(int));
    size_t n = (size_t)a->p[a->n_rows];
    ck_assert(n == 0 || memcmp(a->j, b->j, n * sizeof(int)) == 0);
    ck_assert(n == 0 || memcmp(a->x, b->x, n * sizeof(double)) == 0);
}

static void check_same(const struct dalcs_system *a, const struct dalcs_system *b) {
    ck_assert_int_eq(a->n_x, b->n_x);
    ck_assert_int_eq(a->n_z, b->n_z);
    ck_assert_int_eq(a->n_pairs, b->n_pairs);
    ck_assert_int_eq(a->n_inputs, b->n_inputs);
    ck_assert_int_eq(a->monotone, b->monotone);
    int n = dalcs_system_n_equations(a);
    check_labels(a->row, b->row, n);
    check_labels(a->column, b->column, n);
    ck_assert_mem_eq(a->dual, b->dual, (size_t)n * sizeof(int));
    ck_assert_mem_eq(a->forest_root, b->forest_root, (size_t)n * sizeof(int));
    for (int c = 0; c < dalcs_system_n_columns(a); c++) {
        ck_assert_int_eq(a->column_is_current[c], b->column_is_current[c]);
    }
    for (int r = 0; r < n; r++) {
        ck_assert_int_eq(a->row_is_current[r], b->row_is_current[r]);
    }
    for (int d = 0; d < a->n_pairs; d++) {
        const struct dalcs_pair *p = &a->pair[d];
        const struct dalcs_pair *q = &b->pair[d];
        ck_assert_str_eq(p->element, q->element);
        ck_assert(p->kind == q->kind && p->is_breakdown == q->is_breakdown &&
                  p->initially_on == q->initially_on && p->is_direct == q->is_direct);
        ck_assert(p->turn_on == q->turn_on && p->turn_off == q->turn_off);
    }
    for (int k = 1; k < a->n_inputs; k++) {
        ck_assert_str_eq(a->input_element[k], b->input_element[k]);
    }
    check_matrix(&a->P, &b->P);
    check_matrix(&a->A, &b->A);
    check_matrix(&a->E, &b->E);
    check_matrix(&a->C, &b->C);
    check_matrix(&a->F, &b->F);
    check_matrix(&a->storage, &b->storage);
    check_matrix(&a->control, &b->control);
    check_matrix(&a->direct_control, &b->direct_control);
}

START_TEST(test_round_trip) {
    for (int k = 0; k < N_CIRCUITS; k++) {
        build_good_network(&t, circuit[k]);
        const struct dalcs_system *s = &t.network.system[0];
        double u[16];
        uint64_t mode = 0xa5 & ((1u << s->n_pairs) - 1);
        write_system(s, u, mode);
        struct dalcs_system_file file;
        diag = (struct dalcs_diag){0};
        enum dalcs_status status = dalcs_system_file_read(&file, path, &diag);
        ck_assert_msg(status == DALCS_OK, "%s", diag.n > 0 ? diag.item[0].text : "");
        check_same(s, &file.system);
        ck_assert(file.sigma == 1.0 / 3e-7);
        ck_assert_mem_eq(file.u, u, (size_t)(s->n_x + s->n_inputs) * sizeof(*u));
        ck_assert(s->n_pairs == 0 || file.mode[0] == mode);
        ck_assert_str_eq(file.about, "a step of a test");
        dalcs_system_file_finish(&file);
        ck_assert_ptr_null(file.system.dual);
        text_network_finish(&t);
        unlink(path);
    }
}

END_TEST

static char *read_back(size_t *length) {
    FILE *f = fopen(path, "r");
    ck_assert_ptr_nonnull(f);
    char *text = malloc(1 << 16);
    ck_assert_ptr_nonnull(text);
    *length = fread(text, 1, (1 << 16) - 1, f);
    text[*length] = '\0';
    fclose(f);
    return text;
}

/* Refused, with one message that names a line, and nothing left to free. */
static void check_refused(const char *text, size_t length) {
    struct dalcs_system_file file;
    diag = (struct dalcs_diag){0};
    ck_assert_int_eq(dalcs_system_file_read_text(&file, "damaged", text, length, &diag),
                     DALCS_E_NETLIST);
    ck_assert_uint_eq(diag.n_errors, 1);
    ck_assert_int_gt(diag.item[0].line, 0);
    ck_assert_ptr_null(file.system.dual);
    ck_assert_ptr_null(file.arena.head);
    dalcs_diag_finish(&diag);
}

/* Cut anywhere, any one line missing or twice. */
START_TEST(test_damaged) {
    build_good_network(&t, circuit[1]);
    double u[16];
    size_t length;
    write_system(&t.network.system[0], u, 0);
    char *text = read_back(&length);
    unlink(path);
    for (size_t cut = 0; cut < length - 1; cut++) {
        check_refused(text, cut);
    }
    char *changed = malloc(2 * length);
    ck_assert_ptr_nonnull(changed);
    const char *last_line = text + length - strlen("end\n");
    for (const char *line = text; line < last_line;) {
        const char *next = strchr(line, '\n') + 1;
        size_t before = (size_t)(line - text);
        memcpy(changed, text, before);
        memcpy(changed + before, next, length - (size_t)(next - text));
        check_refused(changed, length - (size_t)(next - line));
        size_t through = (size_t)(next - text);
        memcpy(changed, text, through);
        memcpy(changed + through, line, length - before);
        check_refused(changed, length + (size_t)(next - line));
        line = next;
    }
    free(changed);
    free(text);
    text_network_finish(&t);
}

END_TEST

/* What would lead the engine astray, were it believed. */
START_TEST(test_hostile) {
    build_good_network(&t, circuit[0]);
    double u[4];
    size_t length;
    write_system(&t.network.system[0], u, 0);
    char *text = read_back(&length);
    unlink(path);
    static const char *const change[][2] = {
        {"size 0 2 1 2 1", "size 0 268435455 1 2 1"},
        {"size 0 2 1 2 1", "size 0 2 1 0 1"},
        {"size 0 2 1 2 1", "size -1 3 1 2 1"},
        {"row branch V 1 v1", "row branch V 0 v1"},
        {"row branch V 1 v1", "row branch V 2 v1"},
        {"row node A 0", "row reference A 0"},
        {"\n1 1 -1\n", "\n1 2 -1\n"},
        {"\n1 1 -1\n", "\n2 1 -1\n"},
        {"\n1 1 -1\n", "\n1 1 nan\n"},
        {"\n1 1 -1\n", "\n1 1 1e999\n"},
        {"\n1 1 -1\n", "\n1 1 1k\n"},
        {"matrix E 1", "matrix E 999999999"},
        {"matrix E 1", "matrix E 9999999999"},
        {"mode 0", "mode 2"},
        {"dalcs-system 1", "dalcs-system 2"},
        {"sigma ", "sigma -"},
    };
    size_t n_changes = sizeof(change) / sizeof(change[0]);
    for (size_t k = 0; k < n_changes; k++) {
        char damaged[4096];
        const char *place = strstr(text, change[k][0]);
        ck_assert_msg(place != NULL, "no '%s'", change[k][0]);
        snprintf(damaged, sizeof(damaged), "%.*s%s%s", (int)(place - text), text, change[k][1],
                 place + strlen(change[k][0]));
        check_refused(damaged, strlen(damaged));
    }
    free(text);
    text_network_finish(&t);
    /* A state is in no tree of voltages, neither as a node nor as its root. */
    build_good_network(&t, circuit[2]);
    write_system(&t.network.system[0], u, 0);
    text = read_back(&length);
    unlink(path);
    char *state = strstr(text, "column state V 0 c1");
    char *node = strstr(text, "column node V 1 a");
    ck_assert(state != NULL && node != NULL);
    state[strlen("column state V ")] = '1';
    check_refused(text, length);
    state[strlen("column state V ")] = '0';
    node[strlen("column node V ")] = '0';
    check_refused(text, length);
    free(text);
    text_network_finish(&t);
}

END_TEST

START_TEST(test_unwritable) {
    build_good_network(&t, circuit[0]);
    const double u[] = {1.0, 1.0};
    const uint64_t mode = 0;
    const struct dalcs_system_step step = {.u = u, .mode = &mode, .about = ""};
    const struct dalcs_system *s = &t.network.system[0];
    ck_assert_int_eq(dalcs_system_file_write("no/such/folder/f", s, &step), DALCS_E_IO);
    ck_assert_int_eq(errno, ENOENT);
    /* Nothing but a plain file is replaced, and the failure leaves nothing. */
    snprintf(path, sizeof(path), "test_system_file.%d", (int)getpid());
    char temporary[80];
    snprintf(temporary, sizeof(temporary), "%s.partial", path);
    ck_assert_int_eq(mkfifo(path, 0600), 0);
    ck_assert_int_eq(dalcs_system_file_write(path, s, &step), DALCS_E_IO);
    ck_assert_int_eq(errno, EINVAL);
    struct stat target;
    ck_assert(stat(path, &target) == 0 && S_ISFIFO(target.st_mode));
    ck_assert_int_ne(access(temporary, F_OK), 0);
    unlink(path);
    ck_assert_int_eq(mkdir(path, 0700), 0);
    ck_assert_int_eq(dalcs_system_file_write(path, s, &step), DALCS_E_IO);
    ck_assert_int_eq(errno, EISDIR);
    ck_assert_int_ne(access(temporary, F_OK), 0);
    rmdir(path);
    struct dalcs_system_file file;
    diag = (struct dalcs_diag){0};
    ck_assert_int_eq(dalcs_system_file_read(&file, "no/such/file", &diag), DALCS_E_IO);
    ck_assert_uint_eq(diag.n_errors, 1);
    dalcs_diag_finish(&diag);
    text_network_finish(&t);
}

END_TEST

RUN_TESTS("system_file", test_round_trip, test_damaged, test_hostile, test_unwritable)
