/* Stands in for the Windows library of this name where Wine lacks it (Wine 8 does): for tests alone, as it is not random.
 * Rust's standard library asks it for the keys of hash maps. */

#include <string.h>

__declspec(dllexport) int ProcessPrng(unsigned char *data, size_t length) {
    memset(data, 42, length);
    return 1;
}
