/* A library for LD_AUDIT: a process sees a processor without AVX-512, on x86-64 Linux with glibc. It makes the instruction
 * cpuid a fault (arch_prctl, ARCH_SET_CPUID) and answers it with the bits of AVX-512 cleared. A library for audits starts
 * before any other one, and before functions for different processors are chosen. The C library asks even before that;
 * GLIBC_TUNABLES tells it (run.py). Not for a process that handles SIGSEGV itself, as compilers do. */

#define _GNU_SOURCE
#include <asm/prctl.h>
#include <cpuid.h>
#include <link.h>
#include <signal.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <sys/syscall.h>
#include <ucontext.h>
#include <unistd.h>

static const uint8_t CPUID[] = {0x0f, 0xa2};

/* Leaf 7: F, DQ, IFMA, PF, ER, CD, BW and VL; VBMI, VBMI2, VNNI, BITALG and VPOPCNTDQ; 4VNNIW, 4FMAPS, VP2INTERSECT and
 * FP16; in subleaf 1 BF16. Leaf 7 counts what compilers may use; AVX10 stands in its subleaf 1. */
static const unsigned AVX512_B = 1u << 16 | 1u << 17 | 1u << 21 | 1u << 26 | 1u << 27 | 1u << 28 | 1u << 30 | 1u << 31,
                      AVX512_C = 1u << 1 | 1u << 6 | 1u << 11 | 1u << 12 | 1u << 14,
                      AVX512_D = 1u << 2 | 1u << 3 | 1u << 8 | 1u << 23, AVX512_BF16 = 1u << 5, AVX10 = 1u << 19;

static void set_cpuid(unsigned long is_allowed) { syscall(SYS_arch_prctl, ARCH_SET_CPUID, is_allowed); }

static void answer(int signal_number, siginfo_t* info, void* context) {
    (void)info;
    greg_t* r = ((ucontext_t*)context)->uc_mcontext.gregs;
    if (memcmp((const void*)r[REG_RIP], CPUID, sizeof CPUID) != 0) {
        signal(signal_number, SIG_DFL); /* another fault: it occurs again, and ends the process */
        return;
    }
    const unsigned leaf = (unsigned)r[REG_RAX], subleaf = (unsigned)r[REG_RCX];
    unsigned a, b, c, d;
    set_cpuid(1);
    __cpuid_count(leaf, subleaf, a, b, c, d);
    set_cpuid(0);
    if (leaf == 7 && subleaf == 0) b &= ~AVX512_B, c &= ~AVX512_C, d &= ~AVX512_D;
    if (leaf == 7 && subleaf == 1) a &= ~AVX512_BF16, d &= ~AVX10;
    r[REG_RAX] = a, r[REG_RBX] = b, r[REG_RCX] = c, r[REG_RDX] = d;
    r[REG_RIP] += sizeof CPUID;
}

unsigned la_version(unsigned version) {
    struct sigaction action = {.sa_sigaction = answer, .sa_flags = SA_SIGINFO};
    if (sigaction(SIGSEGV, &action, NULL) != 0 || syscall(SYS_arch_prctl, ARCH_SET_CPUID, 0UL) != 0) {
        static const char message[] = "without_avx512: this processor or kernel cannot hide instructions\n";
        const ssize_t written = write(STDERR_FILENO, message, sizeof message - 1);
        _exit(written < 0 ? 2 : 1);
    }
    return version < LAV_CURRENT ? version : LAV_CURRENT;
}
