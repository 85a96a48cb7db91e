// What every page loads: lets each module add its part to `<main>`, and again
// whenever another `<main>` takes its place.

import * as builder from "./builder.js";
import * as fold from "./fold.js";
import * as keys from "./keys.js";
import * as live from "./live.js";
import * as paint from "./paint.js";
import * as people from "./people.js";
import * as player from "./player.js";
import * as studio from "./studio.js";
import * as swap from "./swap.js";
import * as times from "./times.js";
import * as trace from "./trace.js";
import * as upload from "./upload.js";
import * as walk from "./walk.js";

const MODULES = [
  keys, swap, live, fold, times, player, trace, builder, walk, upload, paint, studio,
  people,
];

swap.begin((main, signal) => {
  for (const module of MODULES) {
    // One that fails takes nothing from the others.
    try { module.enhance(main, signal); } catch (error) { console.error(error); }
  }
});
