/* read_corpus.c - a libFuzzer target on given files, without libFuzzer: what it found before stays mended. */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size);

enum { MAX_BYTES = 1 << 20 };

/* Nothing is changed here. */
size_t LLVMFuzzerMutate(uint8_t *data, size_t size, size_t max_size) {
    (void)data;
    (void)max_size;
    return size;
}

int main(int n_words, char **words) {
    uint8_t *data = malloc(MAX_BYTES);
    int n_missing = data == NULL || n_words < 2 ? 1 : 0;
    for (int k = 1; k < n_words && data != NULL; k++) {
        FILE *file = fopen(words[k], "rb");
        if (file == NULL) {
            perror(words[k]);
            n_missing++;
            continue;
        }
        size_t size = fread(data, 1, MAX_BYTES, file);
        fclose(file);
        printf("%s\n", words[k]);
        fflush(stdout);
        LLVMFuzzerTestOneInput(data, size);
    }
    free(data);
    return n_missing > 0;
}
