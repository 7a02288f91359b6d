// Names of an engine that froth_walk.glsl must not mind, as macros and as names.
#define FRAME 17
#define opacity(x) nothing
#define real half
#define Interval nothing nothing
#define centre 3
struct Ball { float x; };
struct Segment { int a; };
int kRays() { return 3; }
float checked(float x) { return x; }
