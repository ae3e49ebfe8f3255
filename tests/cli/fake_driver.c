/* A libcuda.so.1 that answers what the environment says, so that machines without a GPU can show what grainray makes of an
   old driver or of one that does not start. The CUDA runtime asks for every function through cuGetProcAddress. */
#include <stdlib.h>
#include <string.h>

static int number(const char* name) {
    const char* text = getenv(name);
    return text ? atoi(text) : 0;
}

int cuInit(unsigned flags) {
    (void)flags;
    return number("FAKE_DRIVER_INIT");
}

int cuDriverGetVersion(int* version) {
    *version = number("FAKE_DRIVER_VERSION");
    return 0;
}

static int not_supported(void) { return 801; }

int cuGetProcAddress_v2(const char* name, void** function, int version, unsigned long long flags, int* status) {
    (void)version;
    (void)flags;
    if (status) *status = 0;
    if (!strcmp(name, "cuInit")) *function = (void*)cuInit;
    else if (!strcmp(name, "cuDriverGetVersion")) *function = (void*)cuDriverGetVersion;
    else if (!strcmp(name, "cuGetProcAddress")) *function = (void*)cuGetProcAddress_v2;
    else *function = (void*)not_supported;
    return 0;
}
