/* test_atomic_file.c - an output file is there when complete, and an older one until then. */
#include "atomic_file.h"
#include "sample_plot.h"

#include <dirent.h>
#include <errno.h>

static int n_files(void) {
    DIR *folder = opendir(".");
    ck_assert_ptr_nonnull(folder);
    int n = 0;
    for (struct dirent *entry; (entry = readdir(folder));) {
        n += entry->d_name[0] != '.' ? 1 : 0;
    }
    closedir(folder);
    return n;
}

static void open_and_write(struct dalcs_atomic_file *file, const char *path) {
    ck_assert_int_eq(dalcs_atomic_file_open(file, path), DALCS_OK);
    fputs("new", file->stream);
}

START_TEST(test_commit) {
    write_all("a.csv", "old");
    ck_assert_int_eq(chmod("a.csv", 0640), 0);
    struct dalcs_atomic_file file;
    open_and_write(&file, "a.csv");
    ck_assert_ptr_nonnull(strstr(file.temporary, "a.csv.partial-"));
    check_contents("a.csv", "old");
    ck_assert_int_eq(dalcs_atomic_file_commit(&file), DALCS_OK);
    check_contents("a.csv", "new");
    struct stat status;
    ck_assert_int_eq(stat("a.csv", &status), 0);
    ck_assert_int_eq(status.st_mode & 0777, 0640);
    ck_assert_int_eq(n_files(), 1);
}

END_TEST

START_TEST(test_discard) {
    write_all("a.csv", "old");
    struct dalcs_atomic_file file;
    open_and_write(&file, "a.csv");
    dalcs_atomic_file_discard(&file);
    dalcs_atomic_file_discard(&file);
    check_contents("a.csv", "old");
    ck_assert_int_eq(n_files(), 1);
}

END_TEST

START_TEST(test_keep) {
    static const char *const name[][2] = {
        {"a.csv", "a.partial.csv"}, {"b", "b.partial"}, {"c.d/e", "c.d/e.partial"}};
    ck_assert_int_eq(mkdir("c.d", 0777), 0);
    for (size_t i = 0; i < 3; i++) {
        struct dalcs_atomic_file file;
        char *left_at = NULL;
        open_and_write(&file, name[i][0]);
        ck_assert_int_eq(dalcs_atomic_file_keep(&file, &left_at), DALCS_OK);
        ck_assert_str_eq(left_at, name[i][1]);
        check_contents(left_at, "new");
        free(left_at);
    }
    ck_assert_int_eq(n_files(), 3);
}

END_TEST

/* The link stays and what it points to is replaced. */
START_TEST(test_symbolic_link) {
    ck_assert_int_eq(mkdir("there", 0777), 0);
    write_all("there/a.csv", "old");
    ck_assert_int_eq(symlink("there/a.csv", "link.csv"), 0);
    struct dalcs_atomic_file file;
    open_and_write(&file, "link.csv");
    ck_assert_int_eq(dalcs_atomic_file_commit(&file), DALCS_OK);
    check_contents("there/a.csv", "new");
    struct stat status;
    ck_assert_int_eq(lstat("link.csv", &status), 0);
    ck_assert(S_ISLNK(status.st_mode));
}

END_TEST

START_TEST(test_refusals) {
    struct dalcs_atomic_file file;
    ck_assert_int_eq(mkdir("folder.csv", 0777), 0);
    ck_assert_int_eq(dalcs_atomic_file_open(&file, "folder.csv"), DALCS_E_IO);
    ck_assert_int_eq(file.error, EISDIR);
    ck_assert_int_eq(mkfifo("fifo.csv", 0666), 0);
    ck_assert_int_eq(dalcs_atomic_file_open(&file, "fifo.csv"), DALCS_E_IO);
    ck_assert_int_eq(dalcs_atomic_file_open(&file, "nowhere/a.csv"), DALCS_E_IO);
    ck_assert_int_eq(file.error, ENOENT);
    ck_assert_int_eq(n_files(), 2);
}

END_TEST

RUN_SUITE("atomic_file", test_commit, test_discard, test_keep, test_symbolic_link, test_refusals)
