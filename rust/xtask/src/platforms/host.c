/* Loads a GDExtension as Godot does, and calls its entry point.
 *
 * host LIBRARY ENTRY_POINT MAJOR MINOR PATCH
 *
 * The interface that it hands over says that it is that version of Godot. Under every other name it has one function, which does nothing and
 * returns itself: the entry point fills its tables with functions, and does not yet ask them for more than that.
 * Prints "answer N", what the entry point returned, and "asked for N": the functions that it took. Ends with 0 if the answer is 1 and the
 * extension left what to call at start and end.
 */
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include <windows.h>
#else
#include <dlfcn.h>
#endif

typedef void (*function)(void);

typedef struct {
	int32_t minimum_level;
	void *userdata;
	void (*initialize)(void *userdata, int32_t level);
	void (*deinitialize)(void *userdata, int32_t level);
} initialization;

typedef struct {
	uint32_t major, minor, patch;
	const char *string;
} godot_version;

typedef uint8_t (*entry_point)(function (*get)(const char *), void *library, initialization *out);

static godot_version told;
static char told_string[64];

static void version(godot_version *out) {
	*out = told;
}

static void *itself(void) {
	return (void *)itself;
}

static int asked_for;

static function get(const char *name) {
	asked_for += 1;
	return strcmp(name, "get_godot_version") == 0 ? (function)version : (function)itself;
}

static function find(const char *library, const char *name) {
#ifdef _WIN32
	HMODULE loaded = LoadLibraryA(library);
	if (loaded == NULL) {
		fprintf(stderr, "cannot load %s: error %lu\n", library, GetLastError());
		exit(2);
	}
	function found = (function)GetProcAddress(loaded, name);
#else
	void *loaded = dlopen(library, RTLD_NOW | RTLD_LOCAL);
	if (loaded == NULL) {
		fprintf(stderr, "cannot load the library: %s\n", dlerror());
		exit(2);
	}
	function found = (function)dlsym(loaded, name);
#endif
	if (found == NULL) {
		fprintf(stderr, "%s has no %s\n", library, name);
		exit(2);
	}
	return found;
}

int main(int count, char **words) {
	if (count != 6) {
		fputs("host LIBRARY ENTRY_POINT MAJOR MINOR PATCH\n", stderr);
		return 2;
	}
	told.major = (uint32_t)atoi(words[3]);
	told.minor = (uint32_t)atoi(words[4]);
	told.patch = (uint32_t)atoi(words[5]);
	snprintf(told_string, sizeof told_string, "%s.%s.%s.host", words[3], words[4], words[5]);
	told.string = told_string;
	initialization out = { -1, NULL, NULL, NULL };
	int library = 0;
	entry_point enter = (entry_point)find(words[1], words[2]);
	uint8_t answer = enter(get, &library, &out);
	printf("answer %d\nasked for %d\n", answer, asked_for);
	fflush(stdout);
	return answer == 1 && out.initialize != NULL && out.deinitialize != NULL ? 0 : 1;
}
