/* make_embedded.c - runs during the build: files become arrays of a C file.
 *
 * usage: make_embedded NAME FILE ... > embedded.c */
#include <stdio.h>
#include <string.h>

/* The maps of the library's source are not embedded, so a line that names one is left out. */
static int names_a_map(const char *line) {
    return strncmp(line, "//# sourceMappingURL=", 21) == 0;
}

static int embed(const char *name, const char *path) {
    FILE *file = fopen(path, "rb");
    if (!file) {
        perror(path);
        return 1;
    }
    static char line[1 << 20];
    printf("const char dalcs_embedded_%s[] = {\n", name);
    while (fgets(line, sizeof line, file)) {
        for (const unsigned char *c = (const unsigned char *)line; *c && !names_a_map(line); c++) {
            printf("%d,%s", *c < 128 ? *c : *c - 256, *c == '\n' ? "\n" : "");
        }
    }
    printf("0};\n\n");
    int failed = ferror(file);
    fclose(file);
    return failed;
}

int main(int argc, char **argv) {
    int failed = argc % 2 == 0;
    puts("#include \"embedded.h\"\n");
    for (int i = 1; i + 1 < argc && !failed; i += 2) {
        failed = embed(argv[i], argv[i + 1]);
    }
    return failed;
}
