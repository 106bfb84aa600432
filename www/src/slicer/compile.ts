/** Fetches and compiles a wasm module at the first call, once; also from a server that calls wasm by another type. */
export function compiledOnce(url: string): () => Promise<WebAssembly.Module> {
  let compiled: Promise<WebAssembly.Module> | undefined;
  return () => {
    compiled ??= compile(url);
    // The next who asks tries again.
    compiled.catch(() => {
      compiled = undefined;
    });
    return compiled;
  };
}

async function compile(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url} could not be loaded: ${response.status}`);
  return WebAssembly.compile(await response.arrayBuffer());
}
