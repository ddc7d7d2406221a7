# Reads ctest's LastTest.log, prints "passed failed": Catch's case counts where a program prints them, else 1 per test.
function finish() {
    if (!open) return
    if (cases_passed + cases_failed == 0) {
        # A program that has no case for its tag counts for nothing.
        if (!nothing) { if (ok) passed++; else failed++ }
    } else {
        passed += cases_passed
        failed += cases_failed
        if (!ok && cases_failed == 0) failed++
    }
    open = 0
}
/^[0-9]+\/[0-9]+ Testing: / { finish(); open = 1; ok = 0; nothing = 0; cases_passed = 0; cases_failed = 0 }
/^All tests passed \(/ {
    for (i = 1; i <= NF; i++) if ($i ~ /^cases?\)$/) cases_passed += $(i - 2)
}
/^test cases: / {
    for (i = 1; i <= NF; i++) {
        if ($i == "passed") cases_passed += $(i - 1)
        if ($i == "failed") cases_failed += $(i - 1)
    }
}
/^No test(s ran| cases matched)/ { nothing = 1 }
/^Test Passed\./ { ok = 1 }
END { finish(); print passed + 0, failed + 0 }
