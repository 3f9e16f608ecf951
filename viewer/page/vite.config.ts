// SPDX-License-Identifier: BSD-3-Clause
import { svelte } from "@sveltejs/vite-plugin-svelte";
import { defineConfig } from "vite";

export default defineConfig({
  base: "./",
  plugins: [svelte()],
  build: {
    outDir: "../../build/monitor/page",
    emptyOutDir: true,
    target: "es2022",
    chunkSizeWarningLimit: 900, // three
    rollupOptions: { output: { manualChunks: { three: ["three"] } } },
  },
});
