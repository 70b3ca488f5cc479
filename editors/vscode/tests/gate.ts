/** Waiting in tests. */

/** All promises that can settle by themselves have settled. */
export const settled = (): Promise<void> => new Promise((resolve) => setImmediate(resolve));
