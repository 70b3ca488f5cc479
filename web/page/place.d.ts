export const PYTHON: string;
