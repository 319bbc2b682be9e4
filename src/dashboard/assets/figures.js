// A page whose figures the server has drawn: they can be saved.
import { drawnFigures } from './export.js';

drawnFigures();
