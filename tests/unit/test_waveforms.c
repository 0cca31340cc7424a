/* test_waveforms.c - files of waveforms, whole and broken; what is chosen of them. */
#include "read_waveforms.h"

#include <math.h>

static void refuse_text(const char *text, size_t plot, const char *why) {
    struct dalcs_waveforms w;
    ck_assert_int_eq(dalcs_waveforms_read_text(&w, "a", text, strlen(text), plot, &diag),
                     DALCS_E_OPTION);
    ck_assert_msg(strstr(message(), why) != NULL, "%s", message());
    ck_assert_ptr_null(w.value);
}

/* What the program's own writers write is read back bit by bit. */
START_TEST(test_own_files) {
    static const char *const path[] = {"a.raw", "a.csv"};
    for (int f = 0; f < 2; f++) {
        struct dalcs_table table;
        const struct dalcs_plot plot = sample_plot(DALCS_TRANSIENT);
        ck_assert_int_eq(dalcs_table_init(&table, path[f], true), DALCS_OK);
        ck_assert_int_eq(dalcs_table_begin(&table, &plot), DALCS_OK);
        for (int i = 0; i < 2; i++) {
            ck_assert_int_eq(dalcs_table_rows(&table, 1, &(double){0.1 * i}, sample_row[i]),
                             DALCS_OK);
        }
        ck_assert_int_eq(dalcs_table_end(&table), DALCS_OK);
        ck_assert_int_eq(dalcs_table_commit(&table), DALCS_OK);
        dalcs_table_finish(&table);

        struct dalcs_waveforms w;
        ck_assert_int_eq(dalcs_waveforms_read_file(&w, path[f], 0, &diag), DALCS_OK);
        ck_assert_uint_eq(w.n_columns, 4);
        ck_assert_uint_eq(w.n_rows, 2);
        ck_assert_str_eq(w.name[0], "time");
        for (int c = 0; c < 3; c++) {
            ck_assert_str_eq(w.name[1 + c], sample_name[c]);
            ck_assert_int_eq(w.dimension[1 + c].volt, sample_unit[c] == DALCS_VOLT);
            ck_assert_int_eq(w.dimension[1 + c].ampere, sample_unit[c] == DALCS_AMPERE);
            for (int i = 0; i < 2; i++) {
                ck_assert_int_eq(memcmp(&w.value[4 * i + 1 + c], &sample_row[i][c], sizeof(double)),
                                 0);
            }
        }
        ck_assert_double_eq(w.value[4], 0.1);
        ck_assert_str_eq(w.title, f == 0 ? "a title with a tab" : "");
        dalcs_waveforms_finish(&w);
    }
    struct dalcs_waveforms w;
    ck_assert_int_eq(dalcs_waveforms_read_file(&w, "nothing.raw", 0, &diag), DALCS_E_IO);
    ck_assert_ptr_nonnull(strstr(message(), "cannot read 'nothing.raw'"));
}

END_TEST

static const char two_plots[] = "Title: two\n"
                                "Plotname: Operating Point\n"
                                "Flags: real\n"
                                "No. Variables: 1\n"
                                "No. Points: 1\n"
                                "Variables:\n"
                                "\t0\tv(a)\tvoltage\n"
                                "Values:\n"
                                " 0\t5\n"
                                "\n"
                                "Title: two\n"
                                "Date: today\n"
                                "Plotname: AC Analysis\n"
                                "Flags: complex\n"
                                "No. Variables: 2\n"
                                "No. Points: 2\n"
                                "Variables:\n"
                                "\t0\tfrequency\tfrequency\tgrid=3\n"
                                "\t1\tv(a)\tvoltage\n"
                                "Values:\n"
                                " 0\t1,0\n\t3,4\n\n"
                                " 1\t10,0\n\t0,-2\n\n";

START_TEST(test_text_and_complex) {
    struct dalcs_waveforms w;
    read_text(&w, two_plots, 0);
    ck_assert_uint_eq(w.n_plots, 2);
    ck_assert_uint_eq(w.plot, 2);
    ck_assert_str_eq(w.plot_name, "AC Analysis");
    ck_assert_uint_eq(w.n_columns, 3);
    ck_assert_str_eq(w.name[2], "phase(v(a))");
    ck_assert(w.dimension[2].degree);
    ck_assert_int_eq(w.dimension[0].second, -1);
    const double expected[] = {1.0, 5.0, atan2(4.0, 3.0) * 180.0 / acos(-1.0), 10.0, 2.0, -90.0};
    ck_assert_uint_eq(w.n_rows, 2);
    for (int i = 0; i < 6; i++) {
        ck_assert_double_eq_tol(w.value[i], expected[i], 1e-12);
    }
    dalcs_waveforms_finish(&w);
    read_text(&w, two_plots, 1);
    ck_assert_uint_eq(w.n_rows, 1);
    ck_assert_double_eq(w.value[0], 5.0);
    dalcs_waveforms_finish(&w);
    refuse_text(two_plots, 3, "'a' has 2 plots: there is no plot 3");
}

END_TEST

/* Points that an interrupted writer left, whatever it counted. */
START_TEST(test_cut_short) {
    char text[512];
    for (int claimed = 0; claimed < 10; claimed += 9) {
        int n = snprintf(text, sizeof text,
                         "Title: t\nPlotname: x\nFlags: real\nNo. Variables: 2\nNo. Points: %d\n"
                         "Variables:\n\t0\ttime\ttime\n\t1\tv(a)\tvoltage\nBinary:\n",
                         claimed);
        const double value[] = {0.0, 1.0, 2.0, 3.0, 4.0};
        memcpy(text + n, value, sizeof value);
        struct dalcs_waveforms w;
        text[(size_t)n + sizeof value] = '\0';
        ck_assert_int_eq(
            dalcs_waveforms_read_text(&w, "a", text, (size_t)n + sizeof value, 0, &diag), DALCS_OK);
        ck_assert_uint_eq(w.n_rows, 2);
        ck_assert_double_eq(w.value[3], 3.0);
        dalcs_waveforms_finish(&w);
    }
    struct dalcs_waveforms w;
    read_text(&w, "time,v(a)\n0,1\n1,2\n2,", 0); /* the last line has no end */
    ck_assert_uint_eq(w.n_rows, 3);
    dalcs_waveforms_finish(&w);
    read_text(&w, "time,v(a)\n0,1\n1,2\n2", 0);
    ck_assert_uint_eq(w.n_rows, 2);
    dalcs_waveforms_finish(&w);
}

END_TEST

START_TEST(test_broken_files) {
    refuse_text("", 0, "holds no waveforms: line 1");
    refuse_text("hello\nworld\n", 0, "holds no waveforms: line 2");
    refuse_text("0,1\n2,3\n", 0, "holds no waveforms: line 1");
    refuse_text("time,v(a)\n0,1\n1\n2,3\n", 0,
                "line 3 has 1 value, and the first line has 2 names");
    refuse_text("time,v(a)\n0,1,2\n", 0, "line 2 has 3 values, and the first line has 2 names");
    refuse_text("time,v(a)\n0,1\n1,x\n", 0, "line 3: 'x' is no number for 'v(a)'");
    refuse_text("Title: t\nPlotname: x\n", 0, "no 'Binary:' or 'Values:'");
    refuse_text("Title: t\nFlags: real\nBinary:\n", 0, "does not list its variables");
    refuse_text("Title: t\nNo. Variables: 99999999999999999999\nNo. Points: 5\nVariables:\n"
                "\t0\ttime\ttime\nBinary:\n",
                0, "no 'Binary:' or 'Values:'");
    refuse_text("Title: t\nNo. Variables: 2\nNo. Points: 5\nVariables:\n\t0\ttime\ttime\n"
                "\t1\nBinary:\n",
                0, "does not list its variables");
    struct dalcs_waveforms w;
    read_text(&w,
              "Title: t\nNo. Variables: 1\nNo. Points: 18446744073709551615\nVariables:\n"
              "\t0\ttime\ttime\nBinary:\n",
              0);
    ck_assert_uint_eq(w.n_rows, 0);
    dalcs_waveforms_finish(&w);
}

END_TEST

START_TEST(test_tables_of_others) {
    struct dalcs_waveforms w;
    read_text(&w, "\357\273\277time;\"v(a,b)\";I(L1)\r\n0;1;2\r\n1;;4\r\n\r\n", 0);
    ck_assert_str_eq(w.name[0], "time");
    ck_assert_str_eq(w.name[1], "v(a,b)");
    ck_assert_int_eq(w.dimension[2].ampere, 1);
    ck_assert_uint_eq(w.n_rows, 2);
    ck_assert(isnan(w.value[4]));
    dalcs_waveforms_finish(&w);
    read_text(&w, " time v(a)\n 0 1\n 1e-3   2\n", 0); /* as wrdata of ngspice */
    ck_assert_uint_eq(w.n_columns, 2);
    ck_assert_double_eq(w.value[2], 1e-3);
    dalcs_waveforms_finish(&w);
    read_text(&w, "time,v(a,b),\"a \"\"b\"\"\"\n0,1,2\n", 0);
    ck_assert_uint_eq(w.n_columns, 3);
    ck_assert_str_eq(w.name[1], "v(a,b)");
    ck_assert_str_eq(w.name[2], "a \"b\"");
    dalcs_waveforms_finish(&w);
}

END_TEST

START_TEST(test_runs) {
    struct dalcs_waveforms w;
    size_t first = 0, end = 0;
    read_text(&w, "v1,i(d1)\n0,1\n1,2\n2,3\n0,4\n1,5\n5,9\n4,8\n3,7\n", 0);
    ck_assert_uint_eq(dalcs_waveforms_find_run(&w, 2, &first, &end), 3);
    ck_assert_uint_eq(first, 3);
    ck_assert_uint_eq(end, 6);
    ck_assert_uint_eq(dalcs_waveforms_find_run(&w, 4, &first, &end), 3);
    ck_assert_uint_eq(end, 0);
    dalcs_waveforms_finish(&w);
    read_text(&w, "v1,i(d1)\n5,9\n4,8\n3,7\n", 0);
    ck_assert_uint_eq(dalcs_waveforms_find_run(&w, 1, &first, &end), 1);
    dalcs_waveforms_keep_rows(&w, first, end);
    const double ascending[] = {3.0, 7.0, 4.0, 8.0, 5.0, 9.0};
    ck_assert_int_eq(memcmp(w.value, ascending, sizeof ascending), 0);
    dalcs_waveforms_finish(&w);
}

END_TEST

RUN_SUITE("waveforms", test_own_files, test_text_and_complex, test_cut_short, test_broken_files,
          test_tables_of_others, test_runs)
