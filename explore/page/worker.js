"use strict";
// Runs the library: {library} first, then {scene} for curves, or {scene, frequencies} for opening levels.
let library;

function call(scene, run) {
  const text = new TextEncoder().encode(scene);
  const place = library.scene_text(text.length);
  new Uint8Array(library.memory.buffer, place, text.length).set(text);
  const count = run();
  if (count === 0) {
    throw new Error(new TextDecoder().decode(new Uint8Array(library.memory.buffer, library.message(), library.message_length())));
  }
  return new Float64Array(library.memory.buffer, library.results(), count).slice();
}

onmessage = async ({ data }) => {
  try {
    if (data.library) {
      const unpacked = new Blob([data.library]).stream().pipeThrough(new DecompressionStream("gzip"));
      const bytes = await new Response(unpacked).arrayBuffer();
      library = (await WebAssembly.instantiate(bytes)).instance.exports;
      postMessage({ ready: true });
    } else if (data.frequencies) {
      for (const frequency of data.frequencies) {
        const [level, linear] = call(data.scene, () => library.opening_level(frequency));
        postMessage({ frequency, level, linear });
      }
    } else {
      const begun = performance.now();
      const numbers = call(data.scene, () => library.run_scene());
      postMessage({ numbers, taken: performance.now() - begun });
    }
  } catch (error) {
    postMessage({ error: error instanceof WebAssembly.RuntimeError ? "The computation failed." : error.message });
  }
};
